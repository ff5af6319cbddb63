#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/tolerance_scales.hpp"
#include "tests/measure/drawn_scenes.hpp"

BOOST_AUTO_TEST_SUITE(tolerance_scales)

using namespace qddot;

namespace {

// Sums and square roots of a few numbers, and a cloth's forces that cancel to 1e-13 of its weight.
const auto within_rounding = boost::test_tools::tolerance(1e-12);

Options scales_of(const Scene& scene, const Reductions& reductions = {}) {
  return with_tolerance_scales({}, Model(scene, reductions));
}

// Whether the scene's length [m] and speed [m/s] are these to the bit.
bool has_scales(const Scene& scene, double length, double speed) {
  return scales_of(scene).length == length && scales_of(scene).speed == speed;
}

// Three masses in a plane, none alike, on two springs under tension, all moving.
Scene falling_triangle() {
  Scene scene{.dimension = 2, .gravity = {0, -9.81, 0}};
  scene.nodes = {{.position = {0, 0, 0}, .velocity = {0.3, 0.1, 0}, .mass = 1},
                 {.position = {2, 0.5, 0}, .velocity = {0, -0.2, 0}, .mass = 2},
                 {.position = {1, 1.5, 0}, .velocity = {0.1, 0.4, 0}, .mass = 0.5}};
  scene.springs = {{{0, 1}, {.stiffness = 40, .rest_length = 1.5}},
                   {{1, 2}, {.stiffness = 30, .rest_length = 1}}};
  return scene;
}

// The same motion in units of 1/`length` m and 1/`time` s.
Scene in_units(Scene scene, double length, double time) {
  scene.gravity *= length / (time * time);
  for (Node& node : scene.nodes) {
    node.position *= length;
    node.velocity *= length / time;
  }
  for (Spring& spring : scene.springs) {
    spring.law.rest_length *= length;
    spring.law.stiffness /= time * time;
  }
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_oscillators_speed_is_its_amplitude_times_its_frequency) {
  for (const double x : {0.01, -3.0, 200.0}) {
    const Options options = scales_of(drawn("oscillator", {{"position", x}}));
    BOOST_TEST(options.length == std::abs(x));
    BOOST_TEST(options.speed == 10 * std::abs(x), within_rounding);  // w = sqrt(100 N/m / 1 kg)
  }
  // The speed is that of the start if that is larger.
  BOOST_TEST(scales_of(drawn("oscillator", {{"velocity", -25}})).speed == 25);
}

BOOST_AUTO_TEST_CASE(a_cloth_at_its_rest_lengths_falls_across_itself) {
  for (const double side : {0.3, 1.0, 7.0}) {
    const Scene cloth = drawn("cloth", {{"nodes", 6}, {"side", side}});
    for (const Reductions& reductions : {Reductions(), Reductions::only({Reduction::pins})}) {
      const Options options = scales_of(cloth, reductions);
      BOOST_TEST(options.length == side, within_rounding);
      BOOST_TEST(options.speed == std::sqrt(9.81 * side), within_rounding);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_scene_at_rest_in_balance_has_its_extent_each_second) {
  const Scene chain =
      drawn("chain", {{"nodes", 5}, {"length", 3}, {"gravity", 0}});  // 3/4 m each, not rounded
  BOOST_TEST(has_scales(chain, 3, 3));
  Scene pair{.dimension = 1};
  pair.nodes = {{.position = {0, 0, 0}, .mass = 1}, {.position = {2, 0, 0}, .mass = 1}};
  pair.springs = {{{0, 1}, {.stiffness = 10, .rest_length = 2}}};
  BOOST_TEST(has_scales(pair, 2, 2));
}

BOOST_AUTO_TEST_CASE(a_free_body_is_as_fast_as_its_fastest_node) {
  Scene pair{.dimension = 3};
  pair.nodes = {{.position = {0, 0, 0}, .velocity = {3, 0, 4}, .mass = 1},
                {.position = {2, 0, 0}, .velocity = {3, 0, 4}, .mass = 1}};
  pair.springs = {{{0, 1}, {.stiffness = 10, .rest_length = 2}}};
  for (const Reductions& reductions : {Reductions(), Reductions::only({})}) {
    BOOST_TEST(scales_of(pair, reductions).length == 2);
  }
  // But for what it falls by in closed form, beside which it rests: L/s.
  BOOST_TEST(scales_of(pair, Reductions::only({})).speed == 5);
  BOOST_TEST(scales_of(pair).speed == 2);
}

BOOST_AUTO_TEST_CASE(where_a_scene_is_drawn_does_not_matter) {
  const Options here = scales_of(falling_triangle());
  Scene moved = falling_triangle();
  for (Node& node : moved.nodes) node.position += Eigen::Vector3d(300, -700, 0);
  // Positions of 700 m are rounded to 1e-13 m, of lengths of 1 m.
  BOOST_TEST(scales_of(moved).length == here.length, within_rounding);
  BOOST_TEST(scales_of(moved).speed == here.speed, within_rounding);
}

BOOST_AUTO_TEST_CASE(other_units_give_the_same_lengths_and_speeds) {
  const Options here = scales_of(falling_triangle());
  for (const auto& [length, time] : {std::pair(1000.0, 1.0), {1.0, 1000.0}, {0.01, 60.0}}) {
    const Options there = scales_of(in_units(falling_triangle(), length, time));
    BOOST_TEST(there.length == length * here.length, within_rounding);
    BOOST_TEST(there.speed == length / time * here.speed, within_rounding);
  }
}

BOOST_AUTO_TEST_CASE(nodes_without_mass_have_no_acceleration_to_count) {
  Scene scene = falling_triangle();
  const Scene heavy = scene;
  // A node that hangs on its own spring, far out of balance, within the extent.
  scene.nodes.push_back({.position = {1, 1, 0}});
  scene.springs.push_back({{0, 3}, {.stiffness = 1e-9, .rest_length = 1}});
  for (const Reductions& reductions : {Reductions(), Reductions::only({})}) {
    const Options options = scales_of(scene, reductions), with_mass = scales_of(heavy, reductions);
    BOOST_TEST(options.length == with_mass.length);
    // The spring pulls a mass of 1 kg with 1e-9 N.
    BOOST_TEST(options.speed == with_mass.speed, boost::test_tools::tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(what_is_pinned_has_an_extent_and_no_speed) {
  Scene scene{.dimension = 2, .gravity = {0, -9.81, 0}};
  scene.nodes = {{.pinned = true}, {.position = {3, 4, 0}, .velocity = {7, 0, 0}, .pinned = true}};
  scene.springs = {{{0, 1}, {.stiffness = 10}}};
  BOOST_TEST(has_scales(scene, 4, 4));  // of the coordinates, the widest
}

BOOST_AUTO_TEST_CASE(without_any_extent_a_length_is_a_metre) {
  Scene scene{.dimension = 1};
  BOOST_TEST(has_scales(scene, 1, 1));
  scene.nodes = {{.position = {5, 0, 0}, .mass = 1}};
  BOOST_TEST(has_scales(scene, 1, 1));
}

BOOST_AUTO_TEST_CASE(nothing_else_of_the_options_changes) {
  const Options before{.rtol = 1e-5, .atol = 1e-9, .max_order = 3, .stability_detection = true};
  const Options after = with_tolerance_scales(before, Model(falling_triangle()));
  BOOST_TEST(after.rtol == before.rtol);
  BOOST_TEST(after.atol == before.atol);
  BOOST_TEST(after.step_size == before.step_size);
  BOOST_TEST(after.max_order == before.max_order);
  BOOST_TEST(after.stability_detection == before.stability_detection);
}

BOOST_AUTO_TEST_SUITE_END()
