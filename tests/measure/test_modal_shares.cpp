#include <cmath>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/analysis/linear_motion.hpp"
#include "qddot/measure/motion/modal_shares.hpp"
#include "qddot/scene/scene_file.hpp"

BOOST_AUTO_TEST_SUITE(modal_shares)

using namespace qddot;

namespace {

// A 1D row of equal masses on springs of zero rest length between two walls, at equilibrium. It has
// velocities in some of its modes sin(j pi i/(N+1)), w_j = 2 sqrt(k/m) sin(j pi/(2 (N+1))).
struct Row {
  int count;
  std::vector<std::pair<int, double>> modes;  // number, amplitude [m/s]
  double stiffness = 500, mass = 0.5;

  double omega(int mode) const {
    return 2 * std::sqrt(stiffness / mass) * std::sin(mode * M_PI / (2 * (count + 1)));
  }
  Model scene() const {
    Scene scene{.name = "row", .dimension = 1};
    for (int i = 0; i <= count + 1; ++i) {
      double v = 0;
      for (const auto& [mode, amplitude] : modes) {
        v += amplitude * std::sin(mode * M_PI * i / (count + 1));
      }
      scene.nodes.push_back({.position = {i / (count + 1.0), 0, 0},
                             .velocity = {v, 0, 0},
                             .mass = mass,
                             .pinned = i == 0 || i == count + 1});
    }
    for (std::size_t i = 0; i + 1 < scene.nodes.size(); ++i) {
      scene.springs.push_back({{i, i + 1}, {.stiffness = stiffness}});
    }
    return Model(scene, Reductions::only({Reduction::pins, Reduction::constant_stiffness}));
  }
};

std::vector<State> exact_path(const Model& scene, double until, int looks) {
  const LinearMotion motion(scene.system());
  std::vector<State> path;
  for (int i = 1; i <= looks; ++i) {
    path.push_back(motion.after(scene.initial(), until * i / looks));
  }
  return path;
}

ModalShares shares_of(const Model& scene) {
  auto shares = ModalShares::at_equilibrium(scene);
  BOOST_TEST_REQUIRE(shares.has_value());
  return *shares;
}

}  // namespace

BOOST_AUTO_TEST_CASE(they_add_up_to_the_kinetic_energy) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const int count : {5, 60}) {  // fewer and more than are kept apart
    const Model scene = Row{count, {}}.scene();
    const ModalShares shares = shares_of(scene);
    Vec v(count);
    for (double& x : v) x = normal(random);
    const Vec parts = shares.kinetic(v);
    BOOST_TEST(parts.size() == std::min<Index>(count, ModalShares::most_modes) + 1);
    BOOST_TEST(parts.minCoeff() >= 0);
    // Orthonormal to rounding, over some tens of modes.
    BOOST_TEST(parts.sum() == scene.system().kinetic(v), boost::test_tools::tolerance(1e-12));
    // If all modes are included, nothing is left above them.
    BOOST_TEST((parts[parts.size() - 1] < 1e-12 * parts.sum()) == (count == 5));
  }
}

BOOST_AUTO_TEST_CASE(of_a_linear_chain_they_are_those_of_the_start) {
  // The mean kinetic energy of a mode over whole periods is half of its energy, which is all
  // kinetic at the start. Some hundred periods give errors of 1/(2 w T) and of chance in the looks.
  const Row row{60, {{1, 0.3}, {4, 0.2}, {40, 0.1}}};
  const Model scene = row.scene();
  const ModalShares shares = shares_of(scene);
  const Vec start = shares.kinetic(scene.initial().v);
  const Vec mean = shares.mean(exact_path(scene, 97.3, 20000));
  for (Index j = 0; j < mean.size(); ++j) {
    BOOST_TEST(std::abs(mean[j] - start[j] / start.sum()) < 3e-3);
    if (j != 0 && j != 3 && j != ModalShares::most_modes) BOOST_TEST(mean[j] < 1e-10);
  }
  BOOST_TEST(std::abs(start[3] / start[0] - 4.0 / 9) < 1e-10);
  // The share of modes above those that are kept apart.
  BOOST_TEST(std::abs(start[ModalShares::most_modes] / start[0] - 1.0 / 9) < 1e-10);
}

BOOST_AUTO_TEST_CASE(total_variation_is_the_largest_difference_of_any_event) {
  const Vec a{{0.5, 0.5, 0}}, b{{0.25, 0.25, 0.5}}, c{{0, 0, 1}};
  BOOST_TEST(total_variation(a, a) == 0);
  BOOST_TEST(total_variation(a, b) == 0.5);
  BOOST_TEST(total_variation(a, c) == 1);
  BOOST_TEST(total_variation(c, b) == total_variation(b, c));
}

BOOST_AUTO_TEST_CASE(without_an_equilibrium_there_are_none) {
  Scene falling{.name = "falling", .dimension = 2, .gravity = {0, -9.81, 0}};
  falling.nodes = {{.mass = 1}, {.position = {1, 0, 0}, .mass = 1}};
  falling.springs = {{{0, 1}, {.stiffness = 10, .rest_length = 1}}};
  BOOST_TEST(!ModalShares::at_equilibrium(Model(falling, Reductions::only({Reduction::pins}))));
  BOOST_TEST(ModalShares::at_equilibrium(Model(load_scene("pendulum"))).has_value());
}

BOOST_AUTO_TEST_SUITE_END()
