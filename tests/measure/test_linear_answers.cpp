// Small motions by their modes, as far as an accuracy lets them: what that changes falls with the
// size of the motion, its bound holds, and motions that are not of this kind are left to others.
#include <boost/test/unit_test.hpp>

#include "qddot/measure/advice/solve_linear.hpp"
#include "tests/plain_springs.hpp"

BOOST_AUTO_TEST_SUITE(linear_answers)

using namespace qddot;

namespace {

constexpr double until = 30;

// A string of six masses in space under tension, plucked in two directions.
Scene string(double pluck) {
  Scene scene{.dimension = 3};
  constexpr int nodes = 8;
  for (int i = 0; i < nodes; ++i) {
    const bool pinned = i == 0 || i == nodes - 1;
    Node node{.position = {i / 7., 0, 0}, .mass = 0.02 + 0.001 * i, .pinned = pinned};
    if (!pinned) node.position += pluck * Eigen::Vector3d(0.1, i % 3, i * 0.2);
    scene.nodes.push_back(node);
    if (i > 0)
      scene.springs.push_back({{static_cast<std::size_t>(i - 1), static_cast<std::size_t>(i)},
                               {.stiffness = 1000, .rest_length = 1 / 7. / 1.1}});
  }
  return scene;
}

// The error of an answer, over the largest displacement of the pluck.
double error_of(const LesserAnswer& answer, const Scene& scene, double pluck) {
  const auto truth = PlainSprings(scene).displacements_at(until, 1e-12L, pluck, 100 * pluck);
  double error = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector3d u = answer.answer.nodes[i].position - scene.nodes[i].position;
    error = std::max(error, (u - truth[i]).norm());
  }
  return error / pluck;
}

bool is_linear(const Scene& scene, const Wanted& wanted = {.accuracy = 1e-2},
               const Reductions& reductions = {}) {
  return solve_linear(scene, reductions, until, wanted).has_value();
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_left_out_falls_with_the_size_and_is_bounded) {
  double last_error = 0, last_change = 0;
  for (const double pluck : {1e-6, 1e-7}) {
    const Scene scene = string(pluck);
    const auto found = solve_linear(scene, {}, until, {.accuracy = 1e-3});
    BOOST_TEST_REQUIRE(found.has_value());
    BOOST_TEST(found->answer.method->name == "exact");
    BOOST_TEST((found->answer.error_estimate_kind == EstimateKind::neglected));
    const double error = error_of(*found, scene, pluck);
    // Displacements are up to four plucks, which errors are measured by.
    BOOST_TEST(error <= 4 * found->answer.error_estimate);
    BOOST_TEST(found->change <= found->answer.error_estimate);
    BOOST_TEST(found->answer.error_estimate <= 1e-3);
    BOOST_TEST(found->in_words().find("sum of natural modes") != std::string::npos);
    if (last_error > 0) {
      // The second order falls with the size, the third faster. The bound has a part that is small
      // beside the accuracy.
      BOOST_TEST(last_error / error > 7);
      BOOST_TEST(last_change / found->change > 5);
    }
    last_error = error;
    last_change = found->change;
  }
}

BOOST_AUTO_TEST_CASE(a_path_has_the_same_bound) {
  BOOST_TEST(is_linear(string(1e-7), {.accuracy = 1e-2, .of = AccuracyOf::path}));
  BOOST_TEST(!is_linear(string(1e-7), {.accuracy = 1e-2, .of = AccuracyOf::energy}));
}

BOOST_AUTO_TEST_CASE(air_is_linear_and_much_else_is_not) {
  const double pluck = 1e-7;
  Scene scene = string(pluck);
  scene.air_damping = 0.3;
  const auto found = solve_linear(scene, {}, until, {.accuracy = 1e-2});
  BOOST_TEST_REQUIRE(found.has_value());
  BOOST_TEST(error_of(*found, scene, pluck) <= 4 * found->answer.error_estimate);

  BOOST_TEST(is_linear(string(pluck)));
  BOOST_TEST(!is_linear(string(0.01)));
  BOOST_TEST(!is_linear(string(pluck), {.accuracy = 1e-9}));
  BOOST_TEST(
      !is_linear(string(pluck), {.accuracy = 1e-2}, Reductions().without(Reduction::linear)));
  BOOST_TEST(!is_linear(string(pluck), {.accuracy = 1e-2, .seconds = 0}));

  Scene damped = string(pluck);
  damped.springs[2].law.damping = 0.1;
  BOOST_TEST(!is_linear(damped));
  Scene driven = string(pluck);
  driven.curves.push_back({.harmonics = {{{0, 0, pluck}, 3, 0}}});
  driven.nodes[0].curve = 0;
  BOOST_TEST(!is_linear(driven));
  Scene cable = string(pluck);
  cable.springs[3].law.pulls_only = true;
  BOOST_TEST(!is_linear(cable));
  // Without tension nothing holds the nodes across the line.
  Scene loose = string(pluck);
  for (Spring& spring : loose.springs) spring.law.rest_length = 1 / 7.;
  BOOST_TEST(!is_linear(loose));
}

// A square braced in its plane: a motion in the plane is held, and nothing holds it out of it.
BOOST_AUTO_TEST_CASE(a_plane_that_a_push_leaves_is_not_linear) {
  for (const int dimension : {2, 3}) {
    Scene scene{.dimension = dimension};
    const auto add = [&](double x, double y, bool pinned) {
      scene.nodes.push_back({.position = {x, y, 0}, .mass = 0.02, .pinned = pinned});
    };
    add(0, 0, true);
    add(0, 1, true);
    add(1, 0, false);
    add(1, 1, false);
    const auto join = [&](std::size_t i, std::size_t j) {
      const double l = (scene.nodes[j].position - scene.nodes[i].position).norm();
      scene.springs.push_back({{i, j}, {.stiffness = 1000, .rest_length = l}});
    };
    for (const auto& [i, j] : {std::pair{0, 2}, {1, 3}, {2, 3}, {0, 3}, {1, 2}})
      join(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    scene.nodes[2].velocity = {0, 1e-5, 0};
    scene.nodes[3].velocity = {2e-5, 0, 0};
    BOOST_TEST(is_linear(scene) == (dimension == 2));
  }
}

BOOST_AUTO_TEST_SUITE_END()
