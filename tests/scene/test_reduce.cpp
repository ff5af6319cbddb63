#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(reduce)

using namespace qddot;

namespace {

// A scene of twelve nodes. Five are pinned, though with a velocity. Springs join random nodes: free
// ones, pinned ones, one of each in either order.
Scene random_scene(std::mt19937& random, int dimension) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&](double size) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int d = 0; d < dimension; ++d) x[d] = uniform(-size, size);
    return x;
  };
  Scene scene{.dimension = dimension, .gravity = vector(10)};
  for (std::size_t i = 0; i < 12; ++i) {
    scene.nodes.push_back({.position = vector(1) + i * Eigen::Vector3d::UnitX(),
                           .velocity = vector(2),
                           .mass = uniform(0, 3),
                           .pinned = i % 3 == 1 || i == 3});
  }
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t j = 0; j < 12; ++j) {
      if (i == j || uniform(0, 1) > 0.3) continue;
      scene.springs.push_back({{i, j}, {uniform(0, 100), uniform(0, 3), uniform(0, 10)}});
    }
  }
  return scene;
}

template <class Check>
void for_random_scenes(const Check& check) {
  std::mt19937 random(8);
  for (const int dimension : {1, 2, 3, 3}) check(random_scene(random, dimension), random);
}

// The force on each free node, one after the other.
Vec force_by_hand(const Scene& scene, const std::vector<Node>& nodes) {
  std::vector<double> f;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].pinned) continue;
    Eigen::Vector3d on_node = nodes[i].mass * scene.gravity;
    for (const auto& [ends, law, holds, stiff] : scene.springs) {
      if (ends[0] != i && ends[1] != i) continue;
      const Eigen::Vector3d d =
          nodes[ends[0] == i ? ends[1] : ends[0]].position - nodes[i].position;
      on_node += law.tension(d.norm()) * d.normalized();
    }
    f.insert(f.end(), on_node.begin(), on_node.begin() + scene.dimension);
  }
  return Vec::Map(f.data(), std::ssize(f));
}

// Sums of some 40 springs at 12 nodes, each term rounded a few times, relative to the largest.
constexpr double round_off = 400 * eps;

}  // namespace

BOOST_AUTO_TEST_CASE(free_nodes_have_unknowns_and_pins_stand) {
  for_random_scenes([](const Scene& scene, std::mt19937& random) {
    const ReducedScene reduced(scene);
    const Index n = scene.dimension * 7;
    BOOST_TEST(reduced.dimension() == scene.dimension);
    BOOST_TEST(reduced.system().size() == n);
    BOOST_TEST(reduced.initial().t == 0);
    const State start = reduced.initial();
    for (const State& state : {start, moved(reduced, 0.3, random)}) {
      const std::vector<Node> nodes = reduced.expand(state);
      BOOST_TEST_REQUIRE(nodes.size() == scene.nodes.size());
      Index at = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node &node = nodes[i], &drawn = scene.nodes[i];
        BOOST_TEST(node.mass == drawn.mass);
        BOOST_TEST(node.pinned == drawn.pinned);
        if (drawn.pinned) {
          BOOST_TEST((node.position == drawn.position));
          BOOST_TEST(node.velocity.norm() == 0);
          continue;
        }
        for (int d = 0; d < scene.dimension; ++d, ++at) {
          BOOST_TEST(reduced.system().mass()[at] == drawn.mass);
          BOOST_TEST(start.q[at] == drawn.position[d]);
          BOOST_TEST(start.v[at] == drawn.velocity[d]);
          BOOST_TEST(node.position[d] == state.q[at]);
          BOOST_TEST(node.velocity[d] == state.v[at]);
        }
      }
      BOOST_TEST(at == n);
    }
  });
}

BOOST_AUTO_TEST_CASE(potential_and_force_are_the_sums_over_all_springs_of_the_scene) {
  for_random_scenes([](const Scene& scene, std::mt19937& random) {
    const ReducedScene reduced(scene);
    for (const State& state : {reduced.initial(), moved(reduced, 0.3, random)}) {
      const std::vector<Node> nodes = reduced.expand(state);
      const double v = potential_by_hand(scene, nodes);
      const Vec f = force_by_hand(scene, nodes);
      BOOST_TEST(std::abs(reduced.potential(state) - v) < round_off * std::abs(v));
      BOOST_TEST(distance(force_at(reduced.system(), state.q), f) <
                 round_off * f.cwiseAbs().maxCoeff());
    }
  });
}

BOOST_AUTO_TEST_CASE(springs_between_pins_add_a_constant_to_the_potential_alone) {
  for_random_scenes([](Scene scene, std::mt19937& random) {
    const ReducedScene before(scene);
    // Nodes 1 and 3 are pinned; l of the two is 2 or so.
    scene.springs.push_back({{1, 3}, {.stiffness = 1000, .rest_length = 0.5, .quartic = 20}});
    const ReducedScene after(scene);
    const double added =
        scene.springs.back().law.energy((scene.nodes[1].position - scene.nodes[3].position).norm());
    const State state = moved(before, 0.3, random);
    const Vec& q = state.q;
    const double v = after.potential(state);
    BOOST_TEST(std::abs(v - before.potential(state) - added) < round_off * (v + added));
    BOOST_TEST((force_at(after.system(), q) == force_at(before.system(), q)));
    BOOST_TEST(after.system().stiffness_pattern().nonZeros() ==
               before.system().stiffness_pattern().nonZeros());
  });
}

BOOST_AUTO_TEST_CASE(scene_whose_nodes_are_all_pinned_has_no_unknowns) {
  for_random_scenes([](Scene scene, std::mt19937&) {
    for (Node& node : scene.nodes) node.pinned = true;
    const ReducedScene reduced(scene);
    BOOST_TEST(reduced.system().size() == 0);
    const std::vector<Node> nodes = reduced.expand(reduced.initial());
    BOOST_TEST(nodes.size() == scene.nodes.size());
    const double v = potential_by_hand(scene, nodes);
    BOOST_TEST(std::abs(reduced.potential(reduced.initial()) - v) < round_off * v);
  });
}

BOOST_AUTO_TEST_CASE(scene_without_nodes_is_reduced_to_nothing) {
  const ReducedScene reduced(Scene{.dimension = 2});
  BOOST_TEST(reduced.system().size() == 0);
  BOOST_TEST(reduced.expand(reduced.initial()).empty());
}

BOOST_AUTO_TEST_SUITE_END()
