#include <boost/test/unit_test.hpp>

#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/stability.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(stability)

using namespace qddot;

namespace {

// Eigenvalues of -K are wrong by some roundings of the largest row sum.
constexpr double tolerance = 1e-13;

// The number of clearly negative eigenvalues of -K, by a dense decomposition, and the least of
// them.
struct Truth {
  int negative;
  double least, row_sum;

  Truth(const System& system, const Vec& q) {
    const Eigen::MatrixXd stiff = -dense(stiffness_at(system, q));
    const Vec values = stiff.selfadjointView<Eigen::Lower>().eigenvalues();
    row_sum = stiff.cwiseAbs().rowwise().sum().maxCoeff();
    negative = static_cast<int>((values.array() < -1e-9 * row_sum).count());
    least = values[0];
  }
};

void check(const System& system, const Vec& q) {
  const Truth truth(system, q);
  BOOST_TEST(qddot::curvature_signs(system, q).negative == truth.negative);
  const auto [value, direction] = smallest_curvature(system, q);
  BOOST_TEST(std::abs(value - truth.least) < tolerance * truth.row_sum);
  BOOST_TEST(std::abs(direction.norm() - 1) < tolerance);
  const double quotient = -direction.dot(dense(stiffness_at(system, q)) * direction);
  BOOST_TEST(std::abs(quotient - value) < tolerance * truth.row_sum);
  BOOST_TEST(std::abs(largest_row_sum(stiffness_at(system, q)) - truth.row_sum) <
             tolerance * truth.row_sum);
}

}  // namespace

BOOST_AUTO_TEST_CASE(unstable_directions_are_the_negative_eigenvalues_with_and_without_mass) {
  std::mt19937 random(12);
  int most = 0;
  for (const double stretch : {1.2, 1.0, 0.8, 0.5}) {
    for (const int dimension : {1, 2, 3}) {
      for (const int nodes : {1, 4, 12}) {
        Problem p = random_network(random, dimension, nodes, stretch);
        check(*make_mass_spring(p.network), p.initial.q);
        most = std::max(most,
                        qddot::curvature_signs(*make_mass_spring(p.network), p.initial.q).negative);
        for (int i = 0; i < nodes; i += 2) p.network.node_mass[i] = 0;
        check(*make_mass_spring(p.network), p.initial.q);
      }
    }
  }
  BOOST_TEST(most > 5);  // there was something to count
}

BOOST_AUTO_TEST_CASE(large_cloth_is_counted_as_a_small_one_is) {
  for (const double stretch : {1.1, 1.0, 0.9}) {
    const ReducedScene reduced(stretched(draw("cloth", {{"nodes", 13}}), stretch),
                               Reductions::all_directions());
    check(reduced.system(), reduced.initial().q);
  }
}

BOOST_AUTO_TEST_CASE(free_and_slack_bodies_are_not_unstable) {
  // Nothing holds a chain at rest lengths across, and nothing pushes it there.
  for (const double pins : {0.0, 1.0, 2.0}) {
    const ReducedScene chain(draw("chain", {{"nodes", 40}, {"pinned_ends", pins}}),
                             Reductions::all_directions());
    BOOST_TEST(qddot::curvature_signs(chain.system(), chain.initial().q).negative == 0);
  }
}

BOOST_AUTO_TEST_CASE(strut_between_two_forces_buckles_in_two_directions) {
  // One node between two pins, on springs compressed by 10 %: -K is 2 tau / l < 0 across the line
  // and 2 k along it.
  const auto system =
      make_mass_spring({.dimension = 3,
                        .node_mass = Vec::Ones(1),
                        .anchors = {{0, {-0.9, 0, 0}, {10, 1}}, {0, {0.9, 0, 0}, {10, 1}}}});
  BOOST_TEST(qddot::curvature_signs(*system, Vec::Zero(3)).negative == 2);
  const auto [value, direction] = smallest_curvature(*system, Vec::Zero(3));
  BOOST_TEST(std::abs(value + 2 * 10 * 0.1 / 0.9) < tolerance * 20);
  BOOST_TEST(std::abs(direction[0]) < tolerance);
}

BOOST_AUTO_TEST_CASE(zeros_of_the_metric_become_the_mean_mass) {
  const auto metric = [](const Vec& mass) {
    return metric_of_all(*make_mass_spring({.dimension = 1, .node_mass = mass}));
  };
  BOOST_TEST((metric(Vec{{1, 0, 3}}) == Vec{{1, 2, 3}}));
  BOOST_TEST((metric(Vec{{0, 0}}) == Vec{{1, 1}}));
}

BOOST_AUTO_TEST_CASE(stiffness_that_overflows_is_no_endless_loop) {
  const auto system = make_mass_spring(
      {.dimension = 1, .node_mass = Vec::Ones(1), .anchors = {{0, {0, 0, 0}, {.quartic = 1e300}}}});
  BOOST_CHECK_THROW(qddot::curvature_signs(*system, Vec::Constant(1, 1e10)), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(nothing_is_stable) {
  const auto system = make_mass_spring({.dimension = 3});
  BOOST_TEST(qddot::curvature_signs(*system, Vec()).negative == 0);
  BOOST_TEST(largest_row_sum(system->stiffness_pattern()) == 0);
  BOOST_CHECK_THROW(smallest_curvature(*system, Vec()), std::invalid_argument);
  const auto loose = make_mass_spring({.dimension = 1, .node_mass = Vec::Ones(2)});
  BOOST_TEST(qddot::curvature_signs(*loose, Vec{{0, 1}}).negative == 0);
  BOOST_TEST(smallest_curvature(*loose, Vec{{0, 1}}).value == 0);
}

BOOST_AUTO_TEST_SUITE_END()
