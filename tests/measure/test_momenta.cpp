#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/momenta.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(momenta)

using namespace qddot;

namespace {

constexpr double speed = 1;

// The change of the scene's conserved momenta in an accurate run to `until`.
double change_of_run(const Scene& scene, double until) {
  const Model reduced(scene, Reductions::only({Reduction::pins}));
  const State state = state_after(reduced, method_named("kahan_li8"), 1e-3, until);
  const Momenta momenta(scene);
  BOOST_TEST_REQUIRE(momenta.any_kept());
  return momenta.change(reduced.expand(reduced.initial()), reduced.expand(state), until, speed);
}

// Three masses in a triangle, turning and flying, and pins that springs join to them.
Scene triangle(std::vector<Eigen::Vector3d> pins, Eigen::Vector3d gravity) {
  Scene scene{.name = "triangle", .gravity = gravity};
  scene.nodes = {{.position = {1, 0, 0}, .velocity = {0, 1, 0.5}, .mass = 1},
                 {.position = {0, 1, 0.2}, .velocity = {-1, 0.3, 0}, .mass = 2},
                 {.position = {-1, 0, 0.4}, .velocity = {0, -0.5, 1}, .mass = 0.5}};
  const auto join = [&](std::size_t i, std::size_t j) {
    scene.springs.push_back({{i, j}, {.stiffness = 50, .rest_length = 1}});
  };
  for (std::size_t i = 0; i < 3; ++i) join(i, (i + 1) % 3);
  for (const Eigen::Vector3d& pin : pins) {
    scene.nodes.push_back({.position = pin, .pinned = true});
    for (std::size_t i = 0; i < 3; ++i) join(i, scene.nodes.size() - 1);
  }
  return scene;
}

// The same with loads of these sizes along a direction.
Scene loaded(Scene scene, const Eigen::Vector3d& direction) {
  for (std::size_t i = 0; i < 3; ++i)
    scene.nodes[i].load = (1 + static_cast<double>(i)) * direction;
  return scene;
}

const Eigen::Vector3d none = {0, 0, 0}, down = {0, 0, -9.81}, at = {0.3, 0.2, 2};

}  // namespace

BOOST_AUTO_TEST_CASE(what_symmetry_says_is_kept) {
  // A run of a thousand steps of order 8, which keeps momenta but for rounding.
  constexpr double rounding = 1e-12;
  for (const Scene& scene :
       {triangle({}, none), triangle({}, down), triangle({at}, none), triangle({at}, down),
        triangle({at, {0.3, 0.2, -1}}, down), triangle({at, {1.3, 0.2, 1}}, none),
        loaded(triangle({}, none), {1, 2, 3}), loaded(triangle({}, {1, 0, 0}), down),
        loaded(triangle({at}, down), down)})
    BOOST_TEST(change_of_run(scene, 1) < rounding);
}

BOOST_AUTO_TEST_CASE(what_it_does_not_say_is_not_asked_for) {
  const auto any_kept = [](const Scene& scene) { return Momenta(scene).any_kept(); };
  BOOST_TEST(!any_kept(triangle({at, {1.3, 0.2, 1}}, down)));
  BOOST_TEST(!any_kept(triangle({at, {1.3, 0.2, 1}, {0, 3, 1}}, none)));
  BOOST_TEST(!any_kept(loaded(triangle({at}, down), {1, 0, 0})));
  const Momenta free(loaded(triangle({}, none), {1, 2, 3}));
  BOOST_TEST(free.has_linear());
  BOOST_TEST(free.angular(triangle({}, none).nodes).size() == 1);  // along the loads
  Scene skew = loaded(triangle({}, none), {1, 2, 3});
  skew.nodes[0].load = {1, 0, 0};
  BOOST_TEST(!Momenta(skew).has_angular());
  BOOST_TEST(!any_kept(load_scene("cloth")));
  BOOST_TEST(!any_kept(load_scene("oscillator")));
  BOOST_TEST(any_kept(load_scene("orbit")));
  BOOST_TEST(any_kept(load_scene("pair")));
}

BOOST_AUTO_TEST_CASE(a_push_and_a_turn_are_seen_by_their_size) {
  const Scene scene = triangle({}, none);
  const Momenta momenta(scene);
  auto nodes = scene.nodes;
  nodes[0].velocity += Eigen::Vector3d(0, 0, 0.35);  // 1 kg of 3.5 kg
  BOOST_TEST(momenta.change(scene.nodes, nodes, 0, speed) == 0.1,
             boost::test_tools::tolerance(1e-14));
  // A turn about the pin: 1 kg at 1 m by 0.2 m/s, over 3.5 kg m/s times the extent.
  const Scene held = triangle({none}, down);
  nodes = held.nodes;
  nodes[0].velocity.y() += 0.2;
  const double extent = Eigen::Vector3d(2, 1, 0.4).norm();
  BOOST_TEST(Momenta(held).change(held.nodes, nodes, 0, speed) == 0.2 / (3.5 * extent),
             boost::test_tools::tolerance(1e-14));
  // But not one about another axis than gravity's.
  nodes = held.nodes;
  nodes[0].velocity.z() += 0.2;
  BOOST_TEST(Momenta(held).change(held.nodes, nodes, 0, speed) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
