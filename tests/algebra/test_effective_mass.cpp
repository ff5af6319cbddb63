#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "tests/algebra/unprinted.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(effective_mass)

using namespace qddot;
using Definiteness = EffectiveMass::Definiteness;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// A system and the positions at which K is taken.
struct Case {
  std::shared_ptr<const System> system;
  Vec q;

  SymmetricMatrix k() const { return stiffness_at(*system, q); }
};

Case network_case(const Problem& p) { return {make_mass_spring(p.network), p.initial.q}; }

// A cloth or block with every spring at `stretch` times its rest length and, where asked for, every
// second node without mass.
Case scene_case(const std::string& name, const GeneratorValues& values, double stretch,
                bool some_massless = false) {
  Scene scene = generate(*find_generator(name), values, "test");
  for (Spring& spring : scene.springs) spring.law.rest_length /= stretch;
  for (std::size_t i = 0; some_massless && i < scene.nodes.size(); i += 2) scene.nodes[i].mass = 0;
  const auto reduced = std::make_shared<ReducedScene>(scene, Reductions::only({Reduction::pins}));
  return {{reduced, &reduced->system()}, reduced->initial().q};
}

// Cases from one unknown with a simplicial factor to a few hundred with a supernodal one.
std::vector<Case> cases(double stretch) {
  std::mt19937 random(3);
  std::vector<Case> all;
  for (const int dimension : {1, 2, 3}) {
    for (const int nodes : {1, 2, 8})
      all.push_back(network_case(random_network(random, dimension, nodes, stretch)));
  }
  all.push_back(scene_case("cloth", {{"nodes", 12}}, stretch));
  all.push_back(scene_case("lattice", {{"nodes_x", 9}, {"nodes_y", 5}, {"nodes_z", 5}}, stretch));
  return all;
}

Eigen::MatrixXd effective(const System& system, double a, double s, const SymmetricMatrix& k) {
  Eigen::MatrixXd matrix = -s * dense(k);
  matrix.diagonal() += a * system.mass();
  return matrix;
}

// The largest eigenvalue of K x = lambda M x: a M - s K turns indefinite where s lambda = a.
double largest_eigenvalue(const Case& c) {
  const Vec root = c.system->mass().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd a = root.asDiagonal() * dense(c.k()) * root.asDiagonal();
  return a.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
}

struct Compressed {
  Case at;
  double lambda;  // the largest eigenvalue, positive
};

// The compressed cases that can be indefinite. In 1D none can: a spring has no transverse
// direction.
const std::vector<Compressed>& compressed_cases() {
  static const std::vector<Compressed> all = [] {
    std::vector<Compressed> found;
    for (const Case& c : cases(0.6)) {
      if (const double lambda = largest_eigenvalue(c); lambda > 0) found.push_back({c, lambda});
    }
    return found;
  }();
  return all;
}

// |A x - b| over |A| |x| + |b|, in the largest norm, of a solve with the last factors. It is the
// relative distance of the factorised matrix to A.
double backward_error(EffectiveMass& solver, const Eigen::MatrixXd& a) {
  const Vec b = Vec::LinSpaced(a.rows(), -1, 2);
  Vec x(a.rows());
  solver.solve(b, x);
  const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
  return distance(a * x, b) / (norm * x.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

// Cholesky's backward error is bounded by about n eps; rounding errors of random sign add up to
// its root.
double positive_tolerance(const Eigen::MatrixXd& a) {
  return 10 * eps * std::sqrt(static_cast<double>(a.rows()));
}
// LDL' without pivoting multiplies that by the growth of its entries, which a small pivot makes
// large; this leaves room for a factor of 1e4.
constexpr double indefinite_tolerance = 1e-10;

}  // namespace

BOOST_AUTO_TEST_CASE(solves_positive_matrices_to_round_off) {
  for (const Case& c : cases(1.2)) {
    EffectiveMass solver(*c.system);
    for (const double s : {0.0, 1e-6, 1e-2, 1e6}) {
      BOOST_TEST(solver.factorize(2, s, c.k()) == Definiteness::positive);
      const Eigen::MatrixXd a = effective(*c.system, 2, s, c.k());
      BOOST_TEST(backward_error(solver, a) < positive_tolerance(a));
    }
  }
}

BOOST_AUTO_TEST_CASE(residual_sees_factors_of_a_matrix_off_by_1e_9) {
  for (const Case& c : cases(1.2)) {
    EffectiveMass solver(*c.system);
    BOOST_TEST(solver.factorize(2 * (1 + 1e-9), 1e-6, c.k()) == Definiteness::positive);
    const Eigen::MatrixXd a = effective(*c.system, 2, 1e-6, c.k());
    BOOST_TEST(backward_error(solver, a) > positive_tolerance(a));
  }
}

BOOST_AUTO_TEST_CASE(compression_turns_the_matrix_indefinite_at_the_largest_eigenvalue) {
  for (const auto& [c, lambda] : compressed_cases()) {
    EffectiveMass solver(*c.system);
    // 1 % is far more than the eigenvalue's own error.
    BOOST_TEST(solver.factorize(1, 0.99 / lambda, c.k()) == Definiteness::positive);
    BOOST_TEST(solver.factorize(1, 1.01 / lambda, c.k()) == Definiteness::indefinite);
    BOOST_TEST(solver.factorize_positive(1, 0.99 / lambda, c.k()));
    BOOST_TEST(!solver.factorize_positive(1, 1.01 / lambda, c.k()));
  }
}

BOOST_AUTO_TEST_CASE(negative_pivots_are_as_many_as_negative_eigenvalues) {
  for (const auto& [c, lambda] : compressed_cases()) {
    EffectiveMass solver(*c.system);
    for (const double s : {0.5, 1.01, 2.3, 11.7}) {
      BOOST_TEST((solver.factorize(1, s / lambda, c.k()) != Definiteness::singular));
      const Vec values =
          effective(*c.system, 1, s / lambda, c.k()).selfadjointView<Eigen::Lower>().eigenvalues();
      BOOST_TEST(solver.negative_pivots() == (values.array() < 0).count());
    }
  }
}

BOOST_AUTO_TEST_CASE(another_diagonal_takes_the_place_of_the_masses) {
  for (const Case& c : cases(1.2)) {
    const Vec diagonal = Vec::LinSpaced(c.system->size(), 1, 3);
    EffectiveMass solver(*c.system, diagonal);
    BOOST_TEST(solver.factorize(2, 1e-2, c.k()) == Definiteness::positive);
    Eigen::MatrixXd a = -1e-2 * dense(c.k());
    a.diagonal() += 2 * diagonal;
    BOOST_TEST(backward_error(solver, a) < positive_tolerance(a));
  }
}

BOOST_AUTO_TEST_CASE(small_and_large_cases_become_indefinite) {
  const auto large = std::ranges::count_if(
      compressed_cases(), [](const Compressed& c) { return c.at.system->size() > 400; });
  BOOST_TEST(large == 2);
  BOOST_TEST(compressed_cases().size() >= 5u);
}

BOOST_AUTO_TEST_CASE(solves_indefinite_matrices) {
  for (const auto& [c, lambda] : compressed_cases()) {
    EffectiveMass solver(*c.system);
    for (const double s : {1.01, 2.3, 11.7}) {
      BOOST_TEST(solver.factorize(1, s / lambda, c.k()) == Definiteness::indefinite);
      BOOST_TEST(backward_error(solver, effective(*c.system, 1, s / lambda, c.k())) <
                 indefinite_tolerance);
    }
  }
}

BOOST_AUTO_TEST_CASE(factors_again_and_again_whatever_came_before) {
  for (const auto& [c, lambda] : compressed_cases()) {
    EffectiveMass solver(*c.system);
    for (const double strain : {1.9, 1.0, 1.4, 0.9, 1.6}) {
      const SymmetricMatrix k = stiffness_at(*c.system, strain * c.q);
      const double s = 0.7 / lambda;
      const Eigen::MatrixXd a = effective(*c.system, 1, s, k);
      const auto expected = Eigen::LLT<Eigen::MatrixXd>(a).info() == Eigen::Success
                                ? Definiteness::positive
                                : Definiteness::indefinite;
      BOOST_TEST(solver.factorize_positive(1, s, k) == (expected == Definiteness::positive));
      BOOST_TEST(solver.factorize(1, s, k) == expected);
      BOOST_TEST(backward_error(solver, a) < indefinite_tolerance);
      // Two factorisations come between: one leaves no usable factors, one is of an indefinite
      // matrix.
      BOOST_TEST(solver.factorize(0, 0, k) == Definiteness::singular);
      BOOST_TEST(solver.factorize(1, 1.5 / lambda, c.k()) == Definiteness::indefinite);
    }
  }
}

BOOST_AUTO_TEST_CASE(factorize_positive_solves_as_factorize_does) {
  for (const Case& c : cases(1.2)) {
    EffectiveMass one(*c.system), other(*c.system);
    BOOST_TEST(one.factorize(1, 1e-4, c.k()) == Definiteness::positive);
    BOOST_TEST(other.factorize_positive(1, 1e-4, c.k()));
    const Vec b = Vec::LinSpaced(c.system->size(), 1, -3);
    Vec x(b.size()), y(b.size());
    one.solve(b, x);
    other.solve(b, y);
    BOOST_TEST((x == y));  // the same operations
  }
}

BOOST_AUTO_TEST_CASE(massless_nodes_are_held_by_their_springs) {
  std::mt19937 random(5);
  Problem p = random_network(random, 3, 6, 1.2);
  for (const int i : {0, 2, 3}) p.network.node_mass[i] = 0;
  for (const Case& c : {network_case(p), scene_case("cloth", {{"nodes", 12}}, 1.2, true)}) {
    EffectiveMass solver(*c.system);
    BOOST_TEST(solver.factorize(1, 1e-2, c.k()) == Definiteness::positive);
    const Eigen::MatrixXd a = effective(*c.system, 1, 1e-2, c.k());
    BOOST_TEST(backward_error(solver, a) < positive_tolerance(a));
    // Without K nothing holds them.
    BOOST_TEST(solver.factorize(1, 0, c.k()) == Definiteness::singular);
    BOOST_TEST(!solver.factorize_positive(1, 0, c.k()));
  }
}

BOOST_AUTO_TEST_CASE(free_pair_without_mass_is_singular) {
  const auto system =
      make_mass_spring({.dimension = 1, .node_mass = Vec::Ones(2), .links = {{0, 1, {4}}}});
  const SymmetricMatrix k = stiffness_at(*system, Vec{{0, 1}});
  EffectiveMass solver(*system);
  // [4 -4; -4 4]: its second pivot is zero without any rounding.
  BOOST_TEST(solver.factorize(0, 1, k) == Definiteness::singular);
  BOOST_TEST(!solver.factorize_positive(0, 1, k));
  BOOST_TEST(solver.factorize(1, 1, k) == Definiteness::positive);
}

BOOST_AUTO_TEST_CASE(factors_take_the_room_of_their_numbers) {
  for (const auto who : {Solver::multifrontal, Solver::cholmod}) {
    for (const Case& c : cases(1.2)) {
      const Index n = c.system->size(), entries = c.system->stiffness_pattern().nonZeros();
      const EffectiveMass solver(*c.system, who);
      // Besides the pivots, L has at least the entries of K's lower triangle and at most those of a
      // square, filled up to strips of 8. An entry has 8 bytes, or 12 with its row's index.
      BOOST_TEST(solver.bytes() >= 8 * entries);
      BOOST_TEST(solver.bytes() <= 12 * (n + 16) * (n + 1));
    }
  }
}

BOOST_AUTO_TEST_CASE(no_unknowns_are_solved_for_at_once) {
  const auto system = make_mass_spring({.dimension = 3});
  EffectiveMass solver(*system);
  BOOST_TEST(solver.factorize(1, 1, system->stiffness_pattern()) == Definiteness::positive);
  BOOST_TEST(solver.factorize_positive(1, 1, system->stiffness_pattern()));
  BOOST_TEST(solver.negative_pivots() == 0);
  Vec x;
  solver.solve(Vec(), x);
  BOOST_TEST(x.size() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
