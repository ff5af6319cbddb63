#include <boost/test/unit_test.hpp>

#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/equilibrium.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/linear_motion.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/analysis/stability.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(frequencies)

using namespace qddot;

namespace {

// A system and where it is.
struct Case {
  std::shared_ptr<const System> system;
  Vec q;
  int stretched_in = 0;  // the dimension, if all springs are stretched

  SymmetricMatrix k() const { return stiffness_at(*system, q); }
  // The largest w^2 by Gershgorin, which bounds the rounding of all.
  double width() const {
    const double bound = frequency_bound(*system, q);
    return bound * bound;
  }
};

Case network_case(const Network& network, const Vec& q) { return {make_mass_spring(network), q}; }

Case scene_case(const std::string& name, const GeneratorValues& values, double stretch,
                bool pinned = true) {
  Scene scene = stretched(draw(name, values), stretch);
  for (Node& node : scene.nodes) node.pinned = node.pinned && pinned;
  const auto reduced = std::make_shared<Model>(scene, Reductions::all_directions());
  return {{reduced, &reduced->system()}, reduced->initial().q};
}

// n equal masses in a row between two walls: w_j = 2 sqrt(k/m) sin(j pi / (2 (n+1))).
struct Row {
  int n;
  double k = 3, m = 0.5;

  Case at_rest() const {
    return network_case(row_of_masses(1, n, m, {k, 1}), Vec::LinSpaced(n, 1, n));
  }
  Vec squares() const {
    const Vec phases = Vec::LinSpaced(n, 1, n) * M_PI / (2 * (n + 1));
    return 4 * k / m * phases.array().sin().square();
  }
};

// The error that any method may leave, relative to the largest w^2. Rounding sums up to about root
// n of it. Lanczos stops at a residual of 1e-10 of the inverse, 1e-10 w^2 / (offset of the shift).
constexpr double value_tolerance = 1e-13;
constexpr double vector_tolerance = 1e-9;

// Checks as many modes at either end of all w^2. `width`: the largest of them.
void check_ends(const Case& c, Index most, const Vec& all, double width) {
  const Index count = std::min(most, all.size());
  const auto check = [&](const NaturalModes& modes, const Vec& expected) {
    BOOST_TEST_REQUIRE(modes.squares.size() == count);
    BOOST_TEST(std::is_sorted(modes.squares.begin(), modes.squares.end()));
    const Eigen::MatrixXd &x = modes.shapes, mx = c.system->mass().asDiagonal() * x;
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(count, count);
    BOOST_TEST(distance(x.transpose() * mx, one) < 1e-12);  // rounding of sums of n products
    // |-K x - w^2 M x| / |M^1/2|, in units of w^2: a backward error of w^2.
    const Eigen::MatrixXd kx = c.k().selfadjointView<Eigen::Lower>() * x;
    BOOST_TEST(distance(-kx, mx * modes.squares.asDiagonal()) <=
               vector_tolerance * width * std::sqrt(c.system->mass().maxCoeff()));
    BOOST_TEST(distance(modes.squares, expected) <= value_tolerance * width);
  };
  check(lowest_modes(*c.system, c.q, most), all.head(count));
  check(highest_modes(*c.system, c.q, most), all.tail(count));
}
void check_ends(const Case& c, Index most, const Vec& all) { check_ends(c, most, all, c.width()); }

// Systems too large for the dense path of the code, small enough for that of the test: square
// symmetry (double values), nothing held (six zeros), compression (negative values).
std::vector<Case> large_cases() {
  return {scene_case("cloth", {{"nodes", 14}}, 1.1),
          scene_case("cloth", {{"nodes", 14}}, 1.1, false),
          scene_case("lattice", {{"nodes_x", 6}, {"nodes_y", 6}, {"nodes_z", 6}}, 1, false),
          scene_case("cloth", {{"nodes", 14}}, 0.8)};
}

// A row sum of |K| is at most 2 sum |B|_inf over the springs of its node, |B|_inf <= sqrt(D) |B|_2;
// while w_max^2 >= trace(-K_ii) / (D m_i) >= sum |B|_2 / (D m_i) where every B is positive
// semidefinite. So bound^2 / w_max^2 <= 2 D sqrt(D).
double largest_ratio(int dimension) { return std::sqrt(2 * dimension * std::sqrt(dimension)); }

// V = |q|^2 / 2, without K.
class Plain final : public System {
 public:
  Plain() : System(Vec::Ones(2)) {}
  double potential(const At& at) const override { return 0.5 * at.q.squaredNorm(); }
  void force(const At& at, MutableVec f) const override { f = -at.q; }
};

}  // namespace

BOOST_AUTO_TEST_CASE(row_of_masses_has_its_closed_form_by_either_method) {
  for (const int n : {1, 2, 50, 2000}) check_ends(Row{n}.at_rest(), 12, Row{n}.squares());
}

BOOST_AUTO_TEST_CASE(free_pair_vibrates_with_its_reduced_mass) {
  const double k = 36, m1 = 2, m2 = 3;
  const Case c =
      network_case({.dimension = 3, .node_mass = Vec{{m1, m2}}, .links = {{0, 1, {k, 1}}}},
                   Vec{{0, 0, 0, 0, 1, 0}});
  check_ends(c, 9, Vec{{0, 0, 0, 0, 0, k * (1 / m1 + 1 / m2)}});
}

BOOST_AUTO_TEST_CASE(both_ends_of_large_systems_are_those_of_a_dense_decomposition) {
  for (const Case& c : large_cases()) {
    BOOST_TEST_REQUIRE(c.system->size() > 400);
    const Vec all = squared_frequencies(*c.system, c.q);
    for (const Index count : {1, 3, 10, 25}) check_ends(c, count, all);
  }
}

BOOST_AUTO_TEST_CASE(many_equal_bodies_have_as_many_equal_modes) {
  // 200 pairs in 1D, which nothing joins: 200 zeros and 200 times 2 k / m, of 500 unknowns with 100
  // masses on nothing.
  Network network{.dimension = 1, .node_mass = Vec::Ones(500)};
  for (int i = 0; i < 200; ++i) network.links.push_back({2 * i, 2 * i + 1, {4, 1}});
  Vec all = Vec::Zero(500);
  all.tail(200).setConstant(8);
  check_ends(network_case(network, Vec::LinSpaced(500, 0, 499)), 20, all);
}

BOOST_AUTO_TEST_CASE(masses_that_nothing_pulls_have_zeros_only) {
  for (const int n : {3, 500}) {
    const Network network{.dimension = 1, .node_mass = Vec::Constant(n, 2)};
    check_ends(network_case(network, Vec::Zero(n)), 3, Vec::Zero(n));
  }
}

BOOST_AUTO_TEST_CASE(massless_nodes_follow_and_leave_the_finite_modes) {
  // A row of masses with a massless node in the middle of each spring: two springs of 2 k in line
  // are one of k.
  for (const int n : {5, 300}) {
    const Row row{n};
    Network network = linear_chain(2 * n + 1, 0, 2 * row.k);
    for (int i = 0; i < n; ++i) network.node_mass[2 * i + 1] = row.m;
    const Case c = network_case(network, Vec::LinSpaced(2 * n + 1, 1, 2 * n + 1));
    BOOST_TEST(finite_modes(*c.system) == n);
    check_ends(c, 4, row.squares(), 4 * row.k / row.m);
  }
}

BOOST_AUTO_TEST_CASE(massless_node_without_a_stable_place_is_refused) {
  // A straight spring at rest does not hold a node sideways in 3D, and compressed ones push it
  // away, whatever the rest does.
  for (const int n : {3, 200}) {
    for (const auto& [beside, rest] : {std::pair(1.0, 1.0), {1.1, 0.9}}) {
      Network network{.dimension = 3, .node_mass = Vec::Ones(n)};
      network.node_mass[1] = 0;
      Vec q = Vec::Zero(3 * n);
      for (int i = 0; i < n; ++i) {
        if (i + 1 < n) network.links.push_back({i, i + 1, {4, i < 2 ? beside : rest}});
        q[3 * i] = i;
      }
      const Case c = network_case(network, q);
      BOOST_CHECK_THROW(lowest_modes(*c.system, c.q, 2), std::domain_error);
      BOOST_CHECK_THROW(highest_modes(*c.system, c.q, 2), std::domain_error);
    }
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
        if (stretch > 1) cases.back().stretched_in = dimension;
      }
    }
  }
  for (const Case& c : cases) {
    const double truth = std::sqrt(squared_frequencies(*c.system, c.q).maxCoeff());
    const double found = largest_frequency(*c.system, c.q);
    // No theorem bounds some products, but values crowd at the end: within a tenth. More products
    // search a larger space.
    const double at_least = frequency_at_least(*c.system, c.q),
                 by_few = frequency_at_least(*c.system, c.q, 15);
    BOOST_TEST(at_least <= found * (1 + 1e-3));
    BOOST_TEST(by_few >= 0.9 * found);
    BOOST_TEST(by_few <= at_least * (1 + 100 * eps));
    BOOST_TEST(found <= truth * (1 + 100 * eps));  // rounding of either
    BOOST_TEST(found >= truth * (1 - 1e-4));
    const double bound = frequency_bound(*c.system, c.q);
    BOOST_TEST(bound >= truth * (1 - 20 * eps));  // equal in 1D, but for the eigensolver
    if (c.stretched_in > 0) BOOST_TEST(bound <= truth * largest_ratio(c.stretched_in));
  }
}

BOOST_AUTO_TEST_CASE(row_sums_without_k_are_those_of_k_where_each_block_has_one_spring) {
  // The cloth has fixed points and, beside its mirror, nodes with fewer unknowns.
  for (const bool has_mirror : {false, true}) {
    Reductions reductions = Reductions::all_directions();
    if (!has_mirror) reductions = reductions.without(Reduction::mirror);
    const Model model(stretched(draw("cloth", {{"nodes", 9}}), 1.1), reductions);
    const Vec& q = model.initial().q;
    Vec sums;
    BOOST_TEST_REQUIRE(model.system().bound_row_sums(q, sums));
    const Vec expected = dense(stiffness_at(model.system(), q)).cwiseAbs().rowwise().sum();
    BOOST_TEST((expected.array() <= (1 + 20 * eps) * sums.array()).all());
    const Vec beyond = (sums - expected).cwiseAbs().cwiseQuotient(sums);
    const auto equal = (beyond.array() <= 20 * eps).count();
    BOOST_TEST((has_mirror ? equal > q.size() / 2 : equal == q.size()));
  }
}

BOOST_AUTO_TEST_CASE(frequencies_of_one_and_two_masses_are_those_of_their_closed_forms) {
  const Oscillator o;
  // A spring of l0 = k = 0 has w^2 = 3 c x^2 / m; two free masses of 2 kg on 36 N/m have w^2 =
  // k (1/m + 1/m), and a row of |K| sums up to 2 k. A massless node makes w infinite, but only
  // with stiffness. What neither moves nor pulls has none.
  const Network quartic{
      .dimension = 1, .node_mass = Vec::Ones(1), .anchors = {{0, {0, 0, 0}, {.quartic = 3}}}},
      pair{.dimension = 1, .node_mass = Vec{{2, 2}}, .links = {{0, 1, {.stiffness = 36}}}};
  const auto beside_massless = [](const SpringLaw& law) {
    return Network{.dimension = 1,
                   .node_mass = Vec{{0, 1, 1}},
                   .links = {{0, 1, law}, {1, 2, {.stiffness = 2}}}};
  };
  const struct {
    Network network;
    Vec q;
    double w;
  } cases[] = {{o.problem().network, o.problem().initial.q, o.omega()},
               {pair, Vec{{0, 1}}, 6},
               {quartic, Vec{{0.0}}, 0},
               {quartic, Vec{{2.0}}, 6},
               {beside_massless({.stiffness = 1}), Vec{{0, 1, 2}}, INFINITY},
               {beside_massless({}), Vec{{0, 1, 2}}, 2},
               {{.dimension = 3}, Vec(), 0},
               {{.gravity = {0, 0, -9.81}, .node_mass = Vec::Ones(2)}, Vec::LinSpaced(6, 0, 1), 0}};
  for (const auto& [network, q, w] : cases) {
    const auto system = make_mass_spring(network);
    for (const double found : {frequency_bound(*system, q), largest_frequency(*system, q)})
      BOOST_TEST((found == w || std::abs(found - w) < 4 * eps * w), found << ", not " << w);
  }
}

BOOST_AUTO_TEST_CASE(what_is_computed_from_k_is_refused_where_there_is_none) {
  const Plain system;
  const Vec q = Vec::Ones(2);
  BOOST_CHECK_THROW(frequency_bound(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(largest_frequency(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(frequency_at_least(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(quick_frequency(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(lowest_modes(system, q, 1), std::invalid_argument);
  BOOST_CHECK_THROW(highest_modes(system, q, 1), std::invalid_argument);
  BOOST_CHECK_THROW(smallest_curvature(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(qddot::curvature_signs(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(find_equilibrium(system, q, 1), std::invalid_argument);
  BOOST_CHECK_THROW(LinearMotion{system}, std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
