// A model of a caller's own system: nothing is left out of it, and it has the nodes and energies of
// the scene that its system was made of.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/drawn_system.hpp"
#include "qddot/scene/reduce/part.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(own_model)

using namespace qddot;

namespace {

// The coordinates or velocities of all nodes, node by node.
Vec stacked(const std::vector<Node>& nodes, Eigen::Vector3d Node::*which, int dimension) {
  Vec all(dimension * static_cast<Index>(nodes.size()));
  Index at = 0;
  for (const Node& node : nodes) {
    all.segment(at, dimension) = (node.*which).head(dimension);
    at += dimension;
  }
  return all;
}

// The state of a drawn system in which its nodes are these.
State state_of(const std::vector<Node>& nodes, int dimension) {
  return {0, stacked(nodes, &Node::position, dimension),
          stacked(nodes, &Node::velocity, dimension)};
}

Model own_model(const Scene& scene) {
  return {drawn_system(scene), state_of(scene.nodes, scene.dimension), scene.dimension};
}

// The square in the plane or in space, with a massless node in the middle of its cross if asked.
Scene falling_square(int dimension, double mass_of_the_middle = 0.5) {
  Scene scene = square(dimension);
  scene.gravity = {0, -9.81, 0};
  scene.nodes[4].mass = mass_of_the_middle;
  scene.nodes[0].velocity = {0.1, 0.2, 0};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_has_the_nodes_and_energies_of_the_scene) {
  std::mt19937 random(7);
  for (const int dimension : {2, 3}) {
    const Scene scene = falling_square(dimension);
    const Model reduced(scene), own = own_model(scene);
    BOOST_TEST(own.dimension() == dimension);
    for (int i = 0; i < 3; ++i) {
      const State there = i == 0 ? reduced.initial() : moved(reduced, 0.05, random);
      const std::vector<Node> nodes = reduced.expand(there);
      const State here = state_of(nodes, dimension);
      const std::vector<Node> own_nodes = own.expand(here);
      BOOST_TEST_REQUIRE(own_nodes.size() == nodes.size());
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        BOOST_TEST((own_nodes[k].position == nodes[k].position), "node " << k);
        BOOST_TEST((own_nodes[k].velocity == nodes[k].velocity), "node " << k);
        BOOST_TEST(own_nodes[k].mass == nodes[k].mass);
      }
      const double t = reduced.kinetic(there), v = reduced.potential(there);
      const double rounding = 400 * eps * (t + std::abs(v) + 100);
      BOOST_TEST(std::abs(own.kinetic(here) - t) < rounding);
      BOOST_TEST(std::abs(own.potential(here) - v) < rounding);
      BOOST_TEST(std::abs(own.energy(here) - reduced.energy(there)) < rounding);
    }
  }
}

BOOST_AUTO_TEST_CASE(nothing_is_left_out_of_it) {
  const Scene scene = falling_square(2, 0);
  const Model own = own_model(scene);
  BOOST_TEST(own.findings().empty());
  BOOST_TEST(own.parts().empty());
  BOOST_TEST((own.nodes_by_part() == std::vector<std::vector<std::size_t>>{{0, 1, 2, 3, 4}}));
  BOOST_TEST((own.unknowns_by_part() == std::vector<Index>{10}));
  BOOST_TEST((own.massless_nodes() == std::vector<std::size_t>{4}));
  BOOST_TEST((own.massless_nodes() == Model(scene).massless_nodes()));
  // No node moves in closed form, so time alone changes nothing.
  State later = own.initial();
  later.t = 3;
  const auto at = own.expand(later), beside = own.expand_beside_falls(later);
  for (std::size_t i = 0; i < at.size(); ++i) {
    BOOST_TEST((at[i].position == scene.nodes[i].position));
    BOOST_TEST((beside[i].position == scene.nodes[i].position));
  }
}

BOOST_AUTO_TEST_CASE(its_largest_displacement_is_one_of_a_node) {
  const Model own = own_model(falling_square(2));
  Vec x = Vec::Zero(10);
  x.segment(6, 2) << 3, -4;
  x[0] = 4.5;
  BOOST_TEST((own.largest_by_part(x) == std::vector<double>{5}));
  const Model empty(drawn_system({.dimension = 2}), {0, Vec(0), Vec(0)}, 2);
  BOOST_TEST(empty.largest_by_part(Vec(0)).empty());
}

BOOST_AUTO_TEST_CASE(a_wrong_dimension_or_start_is_refused_in_a_sentence) {
  const std::shared_ptr<const System> system = drawn_system(square());
  const auto refusal = [&](std::shared_ptr<const System> given, Index q, Index v, int dimension) {
    try {
      Model(std::move(given), {0, Vec::Zero(q), Vec::Zero(v)}, dimension);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  BOOST_TEST(refusal(system, 10, 10, 2) == "");
  BOOST_TEST(refusal(nullptr, 10, 10, 2) == "there is no system");
  for (const int dimension : {0, 3, 4, 5}) {
    BOOST_TEST(refusal(system, 10, 10, dimension) ==
               "dimension " + std::to_string(dimension) +
                   " is not allowed; it is 1, 2 or 3 and divides the 10 unknowns");
  }
  BOOST_TEST(refusal(system, 9, 10, 2) ==
             "the start has 9 positions and 10 velocities, and the system 10 unknowns");
  BOOST_TEST(refusal(system, 10, 8, 2) ==
             "the start has 10 positions and 8 velocities, and the system 10 unknowns");
}

BOOST_AUTO_TEST_SUITE_END()
