#include <limits>
#include <random>
#include <stdexcept>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(natural_modes)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// A system and where it is.
struct Case {
  std::shared_ptr<const System> system;
  Vec q;

  SymmetricMatrix k() const { return stiffness_at(*system, q); }
  // The largest w^2 by Gershgorin, which bounds the rounding of all.
  double width() const {
    const double bound = qddot::frequency_bound(*system, q);
    return bound * bound;
  }
};

Case network_case(const Network& network, const Vec& q) { return {make_mass_spring(network), q}; }

Case scene_case(const std::string& name, const GeneratorValues& values, double stretch,
                bool pinned = true) {
  Scene scene = generate(*find_generator(name), values, "test");
  for (Spring& spring : scene.springs) spring.law.rest_length /= stretch;
  for (Node& node : scene.nodes) node.pinned = node.pinned && pinned;
  const auto reduced = std::make_shared<ReducedScene>(scene, Reductions::all_directions());
  return {{reduced, &reduced->system()}, reduced->initial().q};
}

// n equal masses in a row between two walls: w_j = 2 sqrt(k/m) sin(j pi / (2 (n+1))).
struct Row {
  int n;
  double k = 3, m = 0.5;

  Case at_rest() const {
    Network network{.dimension = 1, .node_mass = Vec::Constant(n, m)};
    for (int i = 0; i + 1 < n; ++i) network.links.push_back({i, i + 1, {k, 1}});
    network.anchors = {{0, {-1, 0, 0}, {k, 1}}, {n - 1, {double(n), 0, 0}, {k, 1}}};
    return network_case(network, Vec::LinSpaced(n, 0, n - 1));
  }
  double square(Index j) const {
    const double w = 2 * std::sqrt(k / m) * std::sin(double(j) * M_PI / (2 * (n + 1)));
    return w * w;
  }
};

double orthonormality_error(const Case& c, const NaturalModes& modes) {
  const Eigen::MatrixXd masses =
      modes.shapes.transpose() * c.system->mass().asDiagonal() * modes.shapes;
  return distance(masses, Eigen::MatrixXd::Identity(masses.rows(), masses.cols()));
}

// |-K x - w^2 M x| / |M^1/2| over all modes, in units of w^2: a backward error of w^2.
double residual(const Case& c, const NaturalModes& modes) {
  const Eigen::MatrixXd kx = c.k().selfadjointView<Eigen::Lower>() * modes.shapes;
  const Eigen::MatrixXd r =
      -kx - c.system->mass().asDiagonal() * modes.shapes * modes.squares.asDiagonal();
  return r.cwiseAbs().maxCoeff() / std::sqrt(c.system->mass().maxCoeff());
}

// The error that any method may leave, relative to the largest w^2. Rounding sums up to about root
// n of it. Lanczos stops at a residual of 1e-10 of the inverse, 1e-10 w^2 / (offset of the shift).
constexpr double value_tolerance = 1e-13;
constexpr double vector_tolerance = 1e-9;

void check_pairs(const Case& c, const NaturalModes& modes, Index count) {
  BOOST_TEST_REQUIRE(modes.squares.size() == count);
  BOOST_TEST(std::is_sorted(modes.squares.begin(), modes.squares.end()));
  BOOST_TEST(orthonormality_error(c, modes) < 1e-12);  // rounding of sums of n products
  BOOST_TEST(residual(c, modes) < vector_tolerance * c.width());
}

// All w^2 by a dense decomposition, for systems of positive masses.
Vec all_squares(const Case& c) {
  const Vec root = c.system->mass().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd a = -(root.asDiagonal() * dense(c.k()) * root.asDiagonal());
  return a.selfadjointView<Eigen::Lower>().eigenvalues();
}

// Systems too large for the dense path of the code, small enough for that of the test: square
// symmetry (double values), nothing held (six zeros), compression (negative values).
std::vector<Case> large_cases() {
  return {scene_case("cloth", {{"nodes", 14}}, 1.1),
          scene_case("cloth", {{"nodes", 14}}, 1.1, false),
          scene_case("lattice", {{"nodes_x", 6}, {"nodes_y", 6}, {"nodes_z", 6}}, 1, false),
          scene_case("cloth", {{"nodes", 14}}, 0.8)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(row_of_masses_has_its_closed_form_by_either_method) {
  for (const int n : {1, 2, 50, 2000}) {
    const Row row{n};
    const Case c = row.at_rest();
    const Index count = std::min(n, 12);
    const NaturalModes low = lowest_modes(*c.system, c.q, 12),
                       high = highest_modes(*c.system, c.q, 12);
    check_pairs(c, low, count);
    check_pairs(c, high, count);
    for (Index j = 0; j < count; ++j) {
      BOOST_TEST(std::abs(low.squares[j] - row.square(j + 1)) < value_tolerance * c.width());
      BOOST_TEST(std::abs(high.squares[j] - row.square(n - count + 1 + j)) <
                 value_tolerance * c.width());
    }
  }
}

BOOST_AUTO_TEST_CASE(tolerance_sees_one_mode_taken_for_the_next) {
  const Row row{2000};
  const double width = row.at_rest().width();
  BOOST_TEST(row.square(2) - row.square(1) > 1000 * value_tolerance * width);
  BOOST_TEST(row.square(2000) - row.square(1999) > 1000 * value_tolerance * width);
}

BOOST_AUTO_TEST_CASE(free_pair_vibrates_with_its_reduced_mass) {
  const double k = 36, m1 = 2, m2 = 3;
  const Case c =
      network_case({.dimension = 3, .node_mass = Vec{{m1, m2}}, .links = {{0, 1, {k, 1}}}},
                   Vec{{0, 0, 0, 0, 1, 0}});
  const NaturalModes all = lowest_modes(*c.system, c.q, 9);
  check_pairs(c, all, 6);
  for (Index j = 0; j < 5; ++j) BOOST_TEST(std::abs(all.squares[j]) < value_tolerance * c.width());
  BOOST_TEST(std::abs(all.squares[5] - k * (1 / m1 + 1 / m2)) < value_tolerance * c.width());
}

BOOST_AUTO_TEST_CASE(both_ends_of_large_systems_are_those_of_a_dense_decomposition) {
  for (const Case& c : large_cases()) {
    BOOST_TEST_REQUIRE(c.system->size() > 400);
    const Vec all = all_squares(c);
    for (const Index count : {1, 3, 10, 25}) {
      const NaturalModes low = lowest_modes(*c.system, c.q, count);
      const NaturalModes high = highest_modes(*c.system, c.q, count);
      check_pairs(c, low, count);
      check_pairs(c, high, count);
      BOOST_TEST(distance(low.squares, all.head(count)) < value_tolerance * c.width());
      BOOST_TEST(distance(high.squares, all.tail(count)) < value_tolerance * c.width());
    }
  }
}

BOOST_AUTO_TEST_CASE(large_systems_are_degenerate_free_and_unstable) {
  const auto cases = large_cases();
  const Vec free = lowest_modes(*cases[2].system, cases[2].q, 7).squares;
  BOOST_TEST(free.head(6).cwiseAbs().maxCoeff() < value_tolerance * cases[2].width());
  BOOST_TEST(free[6] > 1e-4 * cases[2].width());
  const Vec high = highest_modes(*cases[1].system, cases[1].q, 10).squares;
  bool has_double = false;
  for (Index j = 0; j + 1 < 10; ++j)
    has_double |= high[j + 1] - high[j] < value_tolerance * cases[1].width();
  BOOST_TEST(has_double);
  BOOST_TEST(lowest_modes(*cases[3].system, cases[3].q, 1).squares[0] < -1e-3 * cases[3].width());
}

BOOST_AUTO_TEST_CASE(many_equal_bodies_have_as_many_equal_modes) {
  // 200 pairs in 1D, which nothing joins: 200 zeros and 200 times 2 k / m, of 500 unknowns with 100
  // masses on nothing.
  Network network{.dimension = 1, .node_mass = Vec::Ones(500)};
  for (int i = 0; i < 200; ++i) network.links.push_back({2 * i, 2 * i + 1, {4, 1}});
  const Case c = network_case(network, Vec::LinSpaced(500, 0, 499));
  const NaturalModes low = lowest_modes(*c.system, c.q, 20),
                     high = highest_modes(*c.system, c.q, 20);
  check_pairs(c, low, 20);
  check_pairs(c, high, 20);
  BOOST_TEST(low.squares.cwiseAbs().maxCoeff() < value_tolerance * 8);
  BOOST_TEST((high.squares.array() - 8).abs().maxCoeff() < value_tolerance * 8);
}

BOOST_AUTO_TEST_CASE(masses_that_nothing_pulls_have_zeros_only) {
  for (const int n : {3, 500}) {
    const Case c = network_case({.dimension = 1, .node_mass = Vec::Constant(n, 2)}, Vec::Zero(n));
    for (const NaturalModes& modes :
         {lowest_modes(*c.system, c.q, 3), highest_modes(*c.system, c.q, 3)}) {
      BOOST_TEST(modes.squares.size() == 3);
      BOOST_TEST(modes.squares.cwiseAbs().maxCoeff() == 0);
      BOOST_TEST(orthonormality_error(c, modes) < 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(massless_nodes_follow_and_leave_the_finite_modes) {
  // A row of masses with a massless node in the middle of each spring: two springs of 2 k in line
  // are one of k.
  for (const int n : {5, 300}) {
    const Row row{n};
    Network network{.dimension = 1, .node_mass = Vec::Zero(2 * n + 1)};
    for (int i = 0; i < n; ++i) network.node_mass[2 * i + 1] = row.m;
    for (int i = 0; i < 2 * n; ++i) network.links.push_back({i, i + 1, {2 * row.k}});
    network.anchors = {{0, {-1, 0, 0}, {2 * row.k}}, {2 * n, {2 * n + 1.0, 0, 0}, {2 * row.k}}};
    const Case c = network_case(network, Vec::LinSpaced(2 * n + 1, 0, 2 * n));
    BOOST_TEST(finite_modes(*c.system) == n);
    const NaturalModes low = lowest_modes(*c.system, c.q, 4),
                       high = highest_modes(*c.system, c.q, 4);
    BOOST_TEST(orthonormality_error(c, low) < 1e-12);
    BOOST_TEST(orthonormality_error(c, high) < 1e-12);
    const double width = 4 * row.k / row.m;
    BOOST_TEST(residual(c, low) < vector_tolerance * width);
    BOOST_TEST(residual(c, high) < vector_tolerance * width);
    for (Index j = 0; j < 4; ++j) {
      BOOST_TEST(std::abs(low.squares[j] - row.square(j + 1)) < value_tolerance * width);
      BOOST_TEST(std::abs(high.squares[j] - row.square(n - 3 + j)) < value_tolerance * width);
    }
  }
}

BOOST_AUTO_TEST_CASE(massless_node_that_nothing_holds_is_refused) {
  // A straight spring at rest does not hold a node sideways in 3D.
  for (const int n : {3, 200}) {
    Network network{.dimension = 3, .node_mass = Vec::Ones(n)};
    network.node_mass[1] = 0;
    for (int i = 0; i + 1 < n; ++i) network.links.push_back({i, i + 1, {4, 1}});
    Vec q = Vec::Zero(3 * n);
    for (int i = 0; i < n; ++i) q[3 * i] = i;
    const Case c = network_case(network, q);
    BOOST_CHECK_THROW(lowest_modes(*c.system, c.q, 2), std::domain_error);
    BOOST_CHECK_THROW(highest_modes(*c.system, c.q, 2), std::domain_error);
  }
}

BOOST_AUTO_TEST_CASE(massless_node_that_its_springs_push_away_is_refused) {
  // A massless node between compressed springs has no stable place, whatever the rest does.
  for (const int n : {3, 200}) {
    Network network{.dimension = 3, .node_mass = Vec::Ones(n)};
    network.node_mass[1] = 0;
    Vec q(3 * n);
    for (int i = 0; i < n; ++i) {
      if (i + 1 < n) network.links.push_back({i, i + 1, {4, i < 2 ? 1.1 : 0.9}});
      q.segment<3>(3 * i) = Eigen::Vector3d(i, 0, 0);
    }
    const Case c = network_case(network, q);
    BOOST_CHECK_THROW(lowest_modes(*c.system, c.q, 2), std::domain_error);
    BOOST_CHECK_THROW(highest_modes(*c.system, c.q, 2), std::domain_error);
  }
}

BOOST_AUTO_TEST_CASE(no_unknowns_have_no_modes) {
  const auto system = make_mass_spring({.dimension = 3});
  BOOST_TEST(finite_modes(*system) == 0);
  BOOST_TEST(lowest_modes(*system, Vec(), 3).squares.size() == 0);
  BOOST_TEST(highest_modes(*system, Vec(), 3).squares.size() == 0);
}

BOOST_AUTO_TEST_CASE(largest_frequency_is_just_below_the_true_one_and_the_bound) {
  std::vector<Case> cases = large_cases();
  for (const int n : {1, 39, 41, 100, 2000}) cases.push_back(Row{n}.at_rest());
  std::mt19937 random(4);
  for (const double stretch : {1.3, 0.6}) {
    for (const int dimension : {1, 2, 3}) {
      for (const int nodes : {1, 7, 60}) {
        const Problem p = random_network(random, dimension, nodes, stretch);
        cases.push_back(network_case(p.network, p.initial.q));
      }
    }
  }
  for (const Case& c : cases) {
    const double truth = std::sqrt(all_squares(c).maxCoeff());
    const double found = largest_frequency(*c.system, c.q);
    // No theorem bounds 30 products, but values crowd at the end: within a tenth.
    const double at_least = frequency_at_least(*c.system, c.q);
    BOOST_TEST(at_least <= found * (1 + 1e-3));
    BOOST_TEST(at_least >= 0.9 * found);
    BOOST_TEST(found <= truth * (1 + 100 * eps));  // rounding of either
    BOOST_TEST(found >= truth * (1 - 1e-4));
    BOOST_TEST(qddot::frequency_bound(*c.system, c.q) >=
               found * (1 - 100 * eps));  // equal for one mass
  }
}

BOOST_AUTO_TEST_CASE(largest_frequency_is_infinite_for_massless_nodes_and_zero_for_none) {
  Network network{.dimension = 1, .node_mass = Vec{{0, 1}}, .links = {{0, 1, {4, 1}}}};
  BOOST_TEST(std::isinf(largest_frequency(*make_mass_spring(network), Vec{{0, 1}})));
  network.links[0].law.stiffness = 0;
  BOOST_TEST(largest_frequency(*make_mass_spring(network), Vec{{0, 1}}) == 0);
  BOOST_TEST(largest_frequency(*make_mass_spring({.dimension = 2}), Vec()) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
