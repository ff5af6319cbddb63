#include <algorithm>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "tests/integrators/scenes.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(placement)

using namespace qddot;

namespace {

using Eigen::Vector3d;

// A scene and how it is run: by Verlet, which makes the same step errors in every frame.
struct Case {
  std::string name;
  Scene scene;
  double h, t_end;

  std::vector<Node> run(const Scene& placed, const Reductions& reductions) const {
    return nodes_after(placed, reductions, method_named("verlet"), h, t_end);
  }
};

std::vector<Case> cases() {
  std::mt19937 random(6);
  Scene body{.gravity = {1, 2, -9}};
  add_random_body(random, 8, {0, 0, 0}, body);
  body.nodes.front().pinned = true;
  add_random_body(random, 3, {0, 5, 0}, body);
  add_random_body(random, 1, {0, 9, 0}, body);
  return {{"cloth", draw("cloth", {{"nodes", 8}}), 1e-3, 0.2},
          {"chain", draw("chain", {{"nodes", 12}}), 1e-4, 0.1},
          {"pair", draw("pair", {}), 1e-2, 2},
          {"pendulum", draw("pendulum", {}), 1e-2, 2},
          {"random bodies", body, 1e-2, 1}};
}

// x -> turn x + shift, and new numbers for all nodes and springs.
struct Placement {
  explicit Placement(std::mt19937& random, std::size_t nodes) : number(nodes) {
    std::normal_distribution<double> normal;
    const Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
    turn = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    for (double& x : shift) x = 3 * normal(random);
    std::iota(number.begin(), number.end(), 0);
    std::ranges::shuffle(number, random);
  }
  Scene of(const Scene& scene, std::mt19937& random) const {
    Scene moved = renumbered(turned(scene, turn, shift), number);
    for (Spring& spring : moved.springs) {
      if (random() % 2 == 0) std::swap(spring.nodes[0], spring.nodes[1]);
    }
    std::ranges::shuffle(moved.springs, random);
    return moved;
  }
  std::vector<Node> back(const std::vector<Node>& moved) const {
    std::vector<Node> nodes;
    for (const std::size_t i : number) {
      Node node = moved[i];
      node.position = turn.transpose() * (node.position - shift);
      node.velocity = turn.transpose() * node.velocity;
      nodes.push_back(node);
    }
    return nodes;
  }

  Eigen::Matrix3d turn;
  Vector3d shift;
  std::vector<std::size_t> number;
};

struct Apart {
  double positions = 0, velocities = 0;
};
Apart apart(const std::vector<Node>& a, const std::vector<Node>& b) {
  Apart most;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most.positions = std::max(most.positions, distance(a[i].position, b[i].position));
    most.velocities = std::max(most.velocities, distance(a[i].velocity, b[i].velocity));
  }
  return most;
}

// The scene with each node that is not pinned beside its place by about `size`.
Scene disturbed(Scene scene, double size) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> deviation(-size, size);
  for (Node& node : scene.nodes) {
    if (node.pinned) continue;
    for (double& x : node.position) x += deviation(random);
  }
  return scene;
}

constexpr double nudge = 1e-9;

// The allowed distance of two runs by rounding. A deviation of the start by a nudge gives the
// distance `by_nudge`. Each step deviates by some eps of coordinates of up to 20 m, with random
// sign.
Apart tolerance(const Case& c, const Apart& by_nudge) {
  const double eps = std::numeric_limits<double>::epsilon();
  const double roundings = std::sqrt(c.t_end / c.h) * 20 * eps / nudge;
  return {roundings * by_nudge.positions, roundings * by_nudge.velocities};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_moved_turned_and_renumbered_moves_in_the_same_way) {
  std::mt19937 random(1);
  for (const Case& c : cases()) {
    const std::vector<Node> plain = c.run(c.scene, with_and_without[0]);
    const Apart by_nudge = apart(plain, c.run(disturbed(c.scene, nudge), with_and_without[0]));
    const Apart most = tolerance(c, by_nudge);
    for (const Reductions& reductions : with_and_without) {
      const Apart here = apart(plain, c.run(c.scene, reductions));
      BOOST_TEST_CONTEXT(c.name) {
        BOOST_TEST(here.positions < most.positions);
        BOOST_TEST(here.velocities < most.velocities);
      }
      for (int sample = 0; sample < 3; ++sample) {
        BOOST_TEST_CONTEXT(c.name << ", placement " << sample) {
          const Placement placement(random, c.scene.nodes.size());
          const Scene moved = placement.of(c.scene, random);
          const Apart there = apart(plain, placement.back(c.run(moved, reductions)));
          BOOST_TEST(there.positions < most.positions);
          BOOST_TEST(there.velocities < most.velocities);
        }
      }
    }
    // A nudge is seen, and the nodes have moved.
    BOOST_TEST(by_nudge.positions > 100 * most.positions);
    BOOST_TEST(apart(plain, c.scene.nodes).positions > 1e6 * most.positions);
  }
}

BOOST_AUTO_TEST_SUITE_END()
