#include <boost/test/unit_test.hpp>

#include "qddot/scene/settle.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(settle)

using namespace qddot;

namespace {

// The sentence in which a scene is refused; "" if it is not.
std::string refusal(const Scene& scene) {
  return refusal_of([&] { settled(scene, "my.toml"); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(pendulum_hangs_and_keeps_its_velocity) {
  Scene scene = draw("pendulum", {{"mass", 2}, {"stiffness", 500}, {"rest_length", 0.7}});
  scene.starts_at_equilibrium = true;
  const Scene rest = settled(scene, "test");
  const Eigen::Vector3d expected(0, 0, -(0.7 + 2 * 9.81 / 500));
  // Force at rounding, 1e-13 N, over the 27 N/m that hold it sideways.
  BOOST_TEST(distance(rest.nodes[1].position, expected) < 1e-13);
  BOOST_TEST((rest.nodes[1].velocity == scene.nodes[1].velocity));
  BOOST_TEST((rest.nodes[0].position == scene.nodes[0].position));
  BOOST_TEST(!rest.starts_at_equilibrium);
}

BOOST_AUTO_TEST_CASE(only_positions_and_the_flag_change) {
  Scene scene = draw("cloth", {{"nodes", 8}});
  scene.name = "mine";
  scene.nodes[0].velocity = {1, 2, 3};  // of a pinned node: as drawn all the same
  const Scene rest = settled(scene, "test");
  Scene back = rest;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].pinned) BOOST_TEST((rest.nodes[i].position == scene.nodes[i].position));
    back.nodes[i].position = scene.nodes[i].position;
  }
  BOOST_TEST(content_hash(back) == content_hash(scene));
  BOOST_TEST(back.name == "mine");
  BOOST_TEST(back.until.value() == scene.until.value());
  BOOST_TEST(content_hash(rest) != content_hash(scene));
}

BOOST_AUTO_TEST_CASE(forces_vanish_at_the_new_positions) {
  const Scene rest = settled(draw("lattice", {{"nodes_x", 6}, {"nodes_y", 3}, {"nodes_z", 3}}), "");
  const Model reduced(rest, Reductions::all_directions());
  const Vec f = force_at(reduced.system(), reduced.initial().q);
  // Rounding of positions of 1 m, times the row sums of 26 springs of 5e4 N/m.
  BOOST_TEST(f.lpNorm<Eigen::Infinity>() < 4 * 26 * 5e4 * eps);
  BOOST_TEST(equilibrium_of(reduced).iterations == 0);
}

BOOST_AUTO_TEST_CASE(scene_is_settled_alike_at_every_scale) {
  // Lengths and gravity 1e6 times as large: the same shape, and the same bounds of steps.
  const GeneratorValues small = {{"nodes", 20}, {"stiffness", 1e3}};
  GeneratorValues large = small;
  large["length"] = 1e6;
  large["gravity"] = 9.81e6;
  const Scene a = settled(draw("chain", small), ""), b = settled(draw("chain", large), "");
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    BOOST_TEST(distance(b.nodes[i].position / 1e6, a.nodes[i].position) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(scene_that_falls_for_ever_is_refused_by_name_and_node) {
  BOOST_TEST(refusal(draw("cloth", {{"nodes", 5}})) == "");
  Scene scene = draw("cloth", {{"nodes", 5}});
  scene.nodes.push_back({.position = {0.3, 0.3, 1}, .mass = 1});
  BOOST_TEST(
      names_all(refusal(scene), {"my.toml: ", "no equilibrium", "falls for ever", "node 25 "}));
  scene.gravity.setZero();
  BOOST_TEST(refusal(scene) == "");
}

BOOST_AUTO_TEST_CASE(what_cannot_move_is_at_rest) {
  Scene scene = draw("cloth", {{"nodes", 3}});
  for (Node& node : scene.nodes) node.pinned = true;
  BOOST_TEST(content_hash(settled(scene, "")) == content_hash(scene));
}

BOOST_AUTO_TEST_SUITE_END()
