// A reduced system has the scene's own energies, written in its unknowns, with any reductions. T
// and V are those of all nodes and springs at expand(q, v); f and K are derivatives of that V.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(reduced_energy)

using namespace qddot;

namespace {

struct Case {
  std::string name;
  Scene scene;
  Reduction reduction;
  Index unknowns;  // with it
};

// Twelve nodes, of which five are pinned, though with a velocity. Springs join random ones: free,
// pinned, or one of each in either order.
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
    const double x = static_cast<double>(i);
    scene.nodes.push_back({.position = vector(0.3) + x * Eigen::Vector3d::UnitX(),
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

Scene with_parallel_springs() {
  Scene scene = draw("chain", {{"nodes", 5}});
  scene.springs.push_back(scene.springs[1]);
  std::swap(scene.springs.back().nodes[0], scene.springs.back().nodes[1]);
  scene.springs.push_back({{0, 4}, {.stiffness = 0, .rest_length = 1}});
  return scene;
}

Scene two_chains_and_a_stray() {
  Scene scene = draw("chain", {{"nodes", 4}});
  const Scene other = turned(draw("chain", {{"nodes", 3}}), some_rotation(), {0, 5, 0});
  for (const Spring& spring : other.springs) {
    scene.springs.push_back({{spring.nodes[0] + 4, spring.nodes[1] + 4}, spring.law});
  }
  scene.nodes.insert(scene.nodes.end(), other.nodes.begin(), other.nodes.end());
  scene.nodes.push_back({.position = {1, 2, 3}, .velocity = {0.5, 0, 1}, .mass = 2});
  return scene;
}

Scene hanging_line(double length) {
  Scene scene{.dimension = 3, .gravity = {0, 0, -2}};
  scene.nodes = {{.position = {1, 2, 0}, .pinned = true},
                 {.position = {1, 2, -1}, .mass = 0.3},
                 {.position = {1, 2, -2.1}, .velocity = {0, 0, 0.4}, .mass = 0.7}};
  scene.springs = {{{0, 1}, {90, length}}, {{2, 1}, {60, length}}};
  return scene;
}

// Two masses on a spring, thrown under gravity askew to it; along the line between them they
// vibrate.
Scene thrown_pair() {
  Scene scene{.dimension = 3, .gravity = {1, -9, 2}};
  scene.nodes = {{.position = {1, 2, 0}, .velocity = {3, -1, 2}, .mass = 0.3},
                 {.position = {1, 2, -1}, .velocity = {3, -1, 3}, .mass = 0.7}};
  scene.springs = {{{0, 1}, {90, 0.8}}};
  return scene;
}

// The scene with a load on every node.
Scene loaded(Scene scene, std::mt19937& random) {
  std::uniform_real_distribution<double> force(-5, 5);
  for (Node& node : scene.nodes) {
    for (int d = 0; d < scene.dimension; ++d) node.load[d] = force(random);
  }
  return scene;
}
// The cloth of 6 x 6 nodes with loads that are images of each other.
Scene cloth_with_mirrored_loads() {
  Scene scene = draw("cloth", {{"nodes", 6}});
  scene.nodes[8].load = {1, 2, 3};
  scene.nodes[26].load = {-1, 2, 3};
  return scene;
}
Scene loaded_pair(const Eigen::Vector3d& load) {
  Scene scene = thrown_pair();
  scene.nodes[0].load = load;
  return scene;
}

// Unknowns: pins, planes and mirrors by hand.
std::vector<Case> cases() {
  const Eigen::Vector3d shift(3, -2, 7);
  const Scene cloth = draw("cloth", {{"nodes", 5}}), even = draw("cloth", {{"nodes", 4}});
  std::vector<Case> all = {
      {"pins", draw("lattice", {{"nodes_x", 3}, {"nodes_y", 2}, {"nodes_z", 2}}), Reduction::pins,
       4 * 3},
      {"duplicates", with_parallel_springs(), Reduction::duplicates, 8},
      {"free flight", two_chains_and_a_stray(), Reduction::free_flight, 6 + 4},
      {"parts", two_chains_and_a_stray(), Reduction::parts, 6 + 4},
      {"plane", draw("chain", {{"nodes", 6}}), Reduction::dimension, 10},
      {"tilted plane", draw("orbit"), Reduction::dimension, 2},
      {"line", hanging_line(0.5), Reduction::dimension, 2},
      // 2 of 25 nodes are pinned; 5 lie on the mirror with two coordinates each, 9 beside it.
      {"mirror through nodes", cloth, Reduction::mirror, 9 * 3 + 5 * 2},
      {"mirror between nodes", even, Reduction::mirror, 7 * 3},
      {"tilted mirror", turned(cloth, some_rotation(), shift), Reduction::mirror, 9 * 3 + 5 * 2},
      // One corner of the square and nothing of its middle.
      {"two mirrors", square(), Reduction::mirror, 2},
      {"two mirrors in space", turned(square(), some_rotation(), shift), Reduction::mirror, 2},
      {"straight line", hanging_line(0.9), Reduction::constant_stiffness, 2},
      {"no rest lengths", hanging_line(0), Reduction::constant_stiffness, 2},
      {"falling", thrown_pair(), Reduction::falling, 2},
      {"mirrored loads", cloth_with_mirrored_loads(), Reduction::mirror, 3 * 17},
      {"mirrored loads, tilted", turned(cloth_with_mirrored_loads(), some_rotation(), shift),
       Reduction::mirror, 3 * 17},
      {"falling with a load", loaded_pair({0, 0, 0.7}), Reduction::falling, 2},
      {"falling with a load askew", loaded_pair({0.3, 0.2, 0.7}), Reduction::falling, 4},
  };
  std::mt19937 random(8);
  for (const int dimension : {1, 2, 3, 3})
    all.push_back({"random", random_scene(random, dimension), Reduction::pins, 7 * dimension});
  for (const int dimension : {1, 2, 3})
    all.push_back({"random", loaded(random_scene(random, dimension), random), Reduction::pins,
                   7 * dimension});
  all.push_back(all.back());
  all.back().unknowns = 0;
  for (Node& node : all.back().scene.nodes) node.pinned = true;
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_reduction_is_found_and_can_be_left_out) {
  for (const auto& [name, scene, reduction, unknowns] : cases()) {
    BOOST_TEST_CONTEXT(name) {
      const Model with(scene), without(scene, Reductions().without(reduction));
      BOOST_TEST(has(with, reduction));
      BOOST_TEST(!has(without, reduction));
      BOOST_TEST(with.system().size() == unknowns);
      BOOST_TEST(without.system().size() >= unknowns);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_start_is_the_scene_as_drawn) {
  for (const auto& [name, scene, reduction, unknowns] : cases()) {
    const Model reduced(scene);
    const auto nodes = reduced.expand(reduced.initial());
    // Positions of about 10 m, turned there and back; random scenes are not turned.
    BOOST_TEST(farthest(nodes, at_start(scene)) <= (name == "random" ? 0 : 50 * eps * 10), name);
    for (std::size_t i = 0; i < nodes.size(); ++i) BOOST_TEST(nodes[i].mass == scene.nodes[i].mass);
  }
}

BOOST_AUTO_TEST_CASE(energies_are_those_of_all_nodes_and_springs) {
  for (const auto& [name, scene, reduction, unknowns] : cases()) {
    for (const Reductions& set : {Reductions(), Reductions().without(reduction),
                                  Reductions::only({}), Reductions::only({reduction})}) {
      const Model reduced(scene, set);
      std::mt19937 random(1);
      for (int sample = 0; sample < 2; ++sample) {
        State state = moved(reduced, 0.05, random);
        // An unknown of a pinned node never moves; what a line has become is linear only until a
        // spring turns.
        if (!set.has(Reduction::pins)) state = reduced.initial();
        state.t = 0.3;
        const auto nodes = reduced.expand(state);
        const double v = potential_by_hand(scene, nodes), t = kinetic_by_hand(nodes);
        // Tens of springs of up to 1e6 N/m are stretched by 0.1 m, each rounded a few times. Rest
        // lengths are known to eps of the place, k l eps. Random scenes have soft springs.
        const double size = std::abs(v) + (name == "random" ? 0 : 1e5);
        BOOST_TEST(std::abs(reduced.potential(state) - v) <= 400 * eps * size, name);
        BOOST_TEST(std::abs(reduced.kinetic(state) - t) < 100 * eps * (t + 1), name);
        BOOST_TEST(std::abs(reduced.energy(state) - t - v) <= 400 * eps * (t + size), name);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(force_and_stiffness_are_derivatives_of_the_scenes_own_potential) {
  for (const auto& [name, scene, reduction, unknowns] : cases()) {
    BOOST_TEST_CONTEXT(name) {
      const Model reduced(scene);
      std::mt19937 random(3);
      const State state = moved(reduced, 0.02, random);
      Scene pulling = scene;  // in a frame that falls nothing has weight but by its loads
      if (has(reduced, Reduction::falling))
        pulling.gravity -= reduced.parts().front().fall().gravity;
      const auto v = [&](const Vec& q) {
        const State at{0, q, state.v};
        return Vec::Constant(1, potential_by_hand(pulling, reduced.expand(at)));
      };
      const auto f = [&](const Vec& q) { return force_at(reduced.system(), q); };
      const Vec slope = finite_difference_jacobian(v, state.q, 1e-3).transpose();
      const Vec force = f(state.q);
      const double scale = force.lpNorm<Eigen::Infinity>();
      // Fourth-order differences at 1e-3 of lengths above 0.2: truncation 1e-9 of the stiffest
      // spring's force, rounding eps V / 1e-3.
      BOOST_TEST(distance(slope, -force) <= 1e-7 * scale);
      const Eigen::MatrixXd k = dense(stiffness_at(reduced.system(), state.q));
      BOOST_TEST(distance(finite_difference_jacobian(f, state.q, 1e-3), k) <=
                 1e-7 * k.lpNorm<Eigen::Infinity>());
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
