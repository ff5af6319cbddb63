// Random scenes with dashpots and air against an independent model, with each set of reductions and
// by each method.
#include <unsupported/Eigen/MatrixFunctions>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/simulation.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/independent/comparison.hpp"
#include "tests/independent/random_scene.hpp"

BOOST_AUTO_TEST_SUITE(damped_motion)

using namespace qddot;

BOOST_AUTO_TEST_CASE(random_damped_scenes_move_as_they_are_drawn) {
  int damped = 0;
  // Each kind of scene three times.
  for (std::uint64_t seed = 500; seed < 533; ++seed) {
    const auto [scene, kind] = damped_scene(seed);
    damped += is_damped(scene);
    BOOST_TEST_CONTEXT("seed " << seed << ", " << kind) {
      for (const std::string& sentence : compare_states(scene, seed).disagreements)
        BOOST_ERROR(sentence);
      const DrawnMotion motion(scene);
      for (const std::string& sentence : compare_reductions(motion).disagreements)
        BOOST_ERROR(sentence);
      if (seed % 3 > 0) continue;
      for (const std::string& sentence : compare_methods(motion).disagreements)
        BOOST_ERROR(sentence);
    }
  }
  BOOST_TEST(damped >= 30);
}

// A standard linear solid: the massless node between a spring and a spring with a dashpot obeys
// c u1' = c v2 + k2 (u2 - u1) - k1 u1, and the mass m u2'' = -k1 u1.
BOOST_AUTO_TEST_CASE(a_massless_node_beside_a_dashpot_is_of_first_order) {
  const Scene scene = parse_scene(
      "dimension = 1\nuntil = 1\nnodes = [{position = [0], pinned = true},"
      " {position = [1], mass = 0}, {position = [2.5], mass = 1}]\n"
      "springs = [{nodes = [0, 1], stiffness = 40, rest_length = 1},"
      " {nodes = [1, 2], stiffness = 10, rest_length = 1, damping = 2}]\n",
      "solid.toml", "", {}, {});
  Eigen::Matrix3d of_motion;
  of_motion << -25, 5, 1, 0, 0, 1, -40, 0, 0;
  const Eigen::Matrix3d flow = of_motion.exp();
  const Eigen::Vector3d end = flow * Eigen::Vector3d(0, 0.5, 0);
  const auto run_of = [&](const char* name, double h) {
    Simulation run(scene, *find_method(name), {.step_size = h});
    BOOST_TEST((run.advance(1).outcome == Outcome::reached_end), name << " at " << h);
    const std::vector<Node> nodes = run.nodes();
    return std::max(std::abs(nodes[1].position[0] - 1 - end[0]),
                    std::abs(nodes[2].position[0] - 2 - end[1]));
  };
  for (const char* name : {"implicit_euler", "semi_implicit_euler", "bdf2"}) {
    const double coarse = run_of(name, 5e-3), fine = run_of(name, 2.5e-3);
    const double order = std::log2(coarse / fine);
    // The next term of the error is some hundredths of the first at these steps.
    BOOST_TEST(std::abs(order - find_method(name)->order) < 0.05, name << ": order " << order);
  }
  Simulation refused(scene, *find_method("ida"), {.rtol = 1e-6});
  BOOST_TEST((refused.advance(1).outcome == Outcome::singular_mass));
}

BOOST_AUTO_TEST_SUITE_END()
