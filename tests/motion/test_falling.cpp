// A part without pins falls as a whole, and is integrated about its centre of mass.
#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/error.hpp"
#include "tests/fragments.hpp"
#include "tests/integrators/scenes.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(falling)

using namespace qddot;

namespace {

// A tetrahedron of unlike masses, its edges at rest as drawn, thrown and left to gravity.
Scene tetrahedron() {
  Scene scene{.dimension = 3, .gravity = {0.5, -9, 1}};
  const Eigen::Vector3d thrown(3, 1, -2);
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d(0, 0, 0), {1, 0.1, 0}, {0.2, 1, 0}, {0.3, 0.2, 1.1}}) {
    const auto i = static_cast<double>(scene.nodes.size());
    scene.nodes.push_back({.position = x, .velocity = thrown, .mass = 0.5 + 0.2 * i});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double length = (scene.nodes[i].position - scene.nodes[j].position).norm();
      scene.springs.push_back({{j, i}, {50, length}});
    }
  }
  return scene;
}

Scene trembling() {
  Scene scene = tetrahedron();
  scene.nodes[1].velocity.x() += 0.5;
  return scene;
}

State run(const Model& scene, double until) {
  return state_after(scene, method_named("kahan_li8"), 1e-3, until);
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_rests_in_its_fall_has_no_unknowns) {
  const Scene scene = tetrahedron();
  const Model reduced(scene);
  BOOST_TEST(reduced.system().size() == 0);
  BOOST_TEST(contains(sentence(reduced, Reduction::falling), {"1 part without pins is at rest"}));
  const State later{2.5, Vec(0), Vec(0)};
  // A few roundings of 40 m and 30 m/s.
  std::vector<Node> fallen = scene.nodes;
  for (Node& node : fallen) {
    node.position += 2.5 * node.velocity + 0.5 * 2.5 * 2.5 * scene.gravity;
    node.velocity += 2.5 * scene.gravity;
  }
  BOOST_TEST(farthest(reduced.expand(later), fallen) < 10 * eps * 40);
  BOOST_TEST(std::abs(reduced.energy(later) - reduced.energy(reduced.initial())) == 0);
  const double t = kinetic_by_hand(reduced.expand(later));
  BOOST_TEST(std::abs(reduced.kinetic(later) - t) < 20 * eps * t);
  const double v = potential_by_hand(scene, reduced.expand(later));
  BOOST_TEST(std::abs(reduced.potential(later) - v) < 100 * eps * std::abs(v));
}

BOOST_AUTO_TEST_CASE(the_motion_about_the_centre_of_mass_and_the_fall_are_the_drawn_motion) {
  const Model reduced(trembling()), drawn(trembling(), Reductions().without(Reduction::falling));
  BOOST_TEST(!has(drawn, Reduction::falling));
  BOOST_TEST(reduced.system().size() == 12);
  for (const double t : {0.3, 2.0}) {
    const State a = run(reduced, t), b = run(drawn, t);
    // Thousands of steps' rounding of coordinates of up to 30 m, at 20 rad/s.
    BOOST_TEST(farthest(reduced.expand(a), drawn.expand(b)) < 1e-10);
    BOOST_TEST(std::abs(reduced.kinetic(a) - drawn.kinetic(b)) < 1e-8);
    BOOST_TEST(std::abs(reduced.potential(a) - drawn.potential(b)) < 1e-8);
    BOOST_TEST(std::abs(reduced.energy(a) - reduced.energy(reduced.initial())) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(a_fall_hides_neither_lines_nor_mirrors) {
  Scene scene{.dimension = 3, .gravity = {1, -9, 2}};
  for (const double x : {-1., 0., 1.}) {
    scene.nodes.push_back({.position = {1, 2 + 1.1 * x, 3}, .velocity = {4, x, 5}, .mass = 1});
  }
  scene.springs = {{{0, 1}, {90, 1}}, {{1, 2}, {90, 1}}};
  const Model reduced(scene);
  BOOST_TEST(reduced.system().size() == 1);  // one end; the middle rests
  BOOST_TEST(reduced.system().stiffness_is_constant());
  BOOST_TEST(contains(sentence(reduced, Reduction::dimension), {"about the centre of mass"}));
  const Model drawn(scene, Reductions::only({}));
  BOOST_TEST(farthest(reduced.expand(run(reduced, 1)), drawn.expand(run(drawn, 1))) < 1e-11);
}

BOOST_AUTO_TEST_CASE(only_what_rests_by_construction_is_left_out) {
  // A compressed spring in balance with a stretched one at the same place: no net force, and yet it
  // may buckle.
  Scene pressed{.dimension = 2, .gravity = {0, -9.81, 0}};
  for (const double x : {0., 1., 2.}) pressed.nodes.push_back({.position = {x, 0, 0}, .mass = 1});
  pressed.springs = {{{0, 1}, {10, 1.5}}, {{1, 2}, {10, 1.5}}, {{0, 2}, {10, 1.5}}};
  BOOST_TEST(Model(pressed).system().size() > 0);
  Scene pinned = tetrahedron();
  pinned.nodes[0].pinned = true;
  BOOST_TEST(!has(Model(pinned), Reduction::falling));
  // A spring that is strained by more than rounding.
  Scene strained = tetrahedron();
  strained.springs[0].law.rest_length *= 1 + 1e-12;
  BOOST_TEST(Model(strained).system().size() == 12);
  // Without mass nothing says how it falls.
  Scene massless = tetrahedron();
  for (Node& node : massless.nodes) node.mass = 0;
  BOOST_TEST(!has(Model(massless), Reduction::falling));
  // Statics have a falling body fall.
  BOOST_TEST(!has(Model(tetrahedron(), Reductions::all_directions()), Reduction::falling));
}

BOOST_AUTO_TEST_CASE(errors_are_measured_beside_the_fall) {
  const Model reduced(trembling());
  Scales scales;
  for (const double t : {0.1, 0.2, 0.3, 5.0}) extend(scales, reduced, run(reduced, t));
  // It falls 110 m at 50 m/s, and trembles by 0.1 m at 0.5 m/s.
  BOOST_TEST(scales.displacement < 2);
  BOOST_TEST(scales.speed < 1);
  BOOST_TEST(scales.kinetic < 0.5);
  // Another part that rests in its fall is no scale for errors, and has no error.
  Scene two = trembling();
  const Scene other = tetrahedron();
  for (const Spring& spring : other.springs)
    two.springs.push_back({{spring.nodes[0] + 4, spring.nodes[1] + 4}, spring.law});
  for (Node node : other.nodes) {
    node.position.x() += 10;
    two.nodes.push_back(node);
  }
  const Model both(two);
  BOOST_TEST(both.system().size() == 12);
  Scales of_both;
  extend(of_both, both, run(both, 0.3));
  BOOST_TEST(of_both.displacement < 1);
  const std::string said = sentence(both, Reduction::falling);
  BOOST_TEST(contains(said, {"1 part without pins falls", "1 part without pins is at rest"}));
}

BOOST_AUTO_TEST_SUITE_END()
