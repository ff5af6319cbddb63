#include <memory>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "tests/algebra/matrices.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(effective_mass)

using namespace qddot;
using Definiteness = EffectiveMass::Definiteness;

namespace {

// A system and the positions at which K is taken.
struct Case {
  std::shared_ptr<const System> system;
  Vec q;

  SymmetricMatrix k() const { return stiffness_at(*system, q); }
  // a M - s K.
  SymmetricMatrix effective(double a, double s) const { return whole(a * system->mass(), s, k()); }
};

Case network_case(const Problem& p) { return {make_mass_spring(p.network), p.initial.q}; }

// A cloth or block with every spring at `stretch` times its rest length and, where asked for, every
// second node without mass.
Case scene_case(const std::string& name, const GeneratorValues& values, double stretch,
                bool some_massless = false) {
  Scene scene = stretched(draw(name, values), stretch);
  for (std::size_t i = 0; some_massless && i < scene.nodes.size(); i += 2) scene.nodes[i].mass = 0;
  const auto reduced = std::make_shared<Model>(scene, Reductions::only({Reduction::pins}));
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
  all.push_back({make_mass_spring({.dimension = 3}), Vec()});
  return all;
}

struct Compressed {
  Case at;
  double lambda;  // the largest eigenvalue of K x = lambda M x, positive
};

// The compressed cases that can be indefinite, where s lambda exceeds a of a M - s K. In 1D none
// can: a spring has no transverse direction.
const std::vector<Compressed>& compressed_cases() {
  static const std::vector<Compressed> all = [] {
    std::vector<Compressed> found;
    for (const Case& c : cases(0.6)) {
      if (c.q.size() == 0) continue;
      const double lambda = -squared_frequencies(*c.system, c.q)[0];
      if (lambda > 0) found.push_back({c, lambda});
    }
    BOOST_TEST(found.size() >= 5u);
    const auto is_large = [](const Compressed& c) { return c.at.system->size() > 400; };
    BOOST_TEST(std::ranges::count_if(found, is_large) == 2);
    return found;
  }();
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(compression_turns_the_matrix_indefinite_at_the_largest_eigenvalue) {
  for (const auto& [c, lambda] : compressed_cases()) {
    EffectiveMass solver(*c.system);
    // 1 % is far more than the eigenvalue's own error.
    for (const double s : {0.5, 0.99, 1.01, 2.3, 11.7}) {
      BOOST_TEST(solver.factorize_positive(1, s / lambda, c.k()) == (s < 1));
      BOOST_TEST(solver.factorize(1, s / lambda, c.k()) ==
                 (s < 1 ? Definiteness::positive : Definiteness::indefinite));
      const SymmetricMatrix a = c.effective(1, s / lambda);
      const Vec values = eigenvalues(Eigen::MatrixXd(a));
      BOOST_TEST(solver.negative_pivots() == (values.array() < 0).count());
      BOOST_TEST(backward_error(solver, a) < indefinite_tolerance);
    }
  }
}

BOOST_AUTO_TEST_CASE(masses_or_another_diagonal_are_solved_with_to_round_off) {
  for (const Case& c : cases(1.2)) {
    const Index n = c.system->size();
    const Vec other = Vec::LinSpaced(n, 1, 3), b = Vec::LinSpaced(n, 1, -3);
    EffectiveMass with_masses(*c.system), with_other(*c.system, other);
    for (auto [solver, diagonal] :
         {std::pair<EffectiveMass*, Vec>(&with_masses, c.system->mass()), {&with_other, other}}) {
      for (const double s : {0.0, 1e-6, 1e-4, 1e-2, 1e6}) {
        Vec x(n), y(n);
        BOOST_TEST(solver->factorize_positive(2, s, c.k()));
        solver->solve(b, x);
        BOOST_TEST(solver->factorize(2, s, c.k()) == Definiteness::positive);
        solver->solve(b, y);
        BOOST_TEST((x == y));  // the same operations
        BOOST_TEST(solver->negative_pivots() == 0);
        const SymmetricMatrix a = whole(2 * diagonal, s, c.k());
        BOOST_TEST(backward_error(*solver, a) < tolerance_of(a));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(factors_again_and_again_whatever_came_before) {
  for (const auto& [c, lambda] : compressed_cases()) {
    EffectiveMass solver(*c.system);
    for (const double strain : {1.9, 1.0, 1.4, 0.9, 1.6}) {
      const SymmetricMatrix k = stiffness_at(*c.system, strain * c.q);
      const double s = 0.7 / lambda;
      const SymmetricMatrix a = whole(c.system->mass(), s, k);
      const auto expected = Eigen::LLT<Eigen::MatrixXd>(dense(a)).info() == Eigen::Success
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

BOOST_AUTO_TEST_CASE(massless_nodes_are_held_by_their_springs) {
  std::mt19937 random(5);
  Problem p = random_network(random, 3, 6, 1.2);
  for (const int i : {0, 2, 3}) p.network.node_mass[i] = 0;
  for (const Case& c : {network_case(p), scene_case("cloth", {{"nodes", 12}}, 1.2, true)}) {
    EffectiveMass solver(*c.system);
    BOOST_TEST(solver.factorize(1, 1e-2, c.k()) == Definiteness::positive);
    const SymmetricMatrix a = c.effective(1, 1e-2);
    BOOST_TEST(backward_error(solver, a) < tolerance_of(a));
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
      // L has the pivots, and at least the entries of K's lower triangle. It has at most those of a
      // square, filled up to strips of 8. An entry has 8 bytes, or 12 with its row's index.
      BOOST_TEST(solver.bytes() >= 8 * entries);
      BOOST_TEST(solver.bytes() <= 12 * (n + 16) * (n + 1));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
