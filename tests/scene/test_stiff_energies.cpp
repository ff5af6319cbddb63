#include <boost/test/unit_test.hpp>

#include "qddot/scene/stiff_energies.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(stiff_energies)

using namespace qddot;

namespace {

constexpr double tolerance = 1e-14;  // of sums of a few numbers of order one

// Two masses of 2 and 3 kg, 1.3 m apart in the direction (5, 12)/13, on a stiff spring.
Scene pair_of(const Eigen::Vector3d& v1, const Eigen::Vector3d& v2) {
  Scene scene{.dimension = 2, .stiff_above = 50};
  scene.nodes = {{.position = {1, 1, 0}, .velocity = v1, .mass = 2},
                 {.position = {1.5, 2.2, 0}, .velocity = v2, .mass = 3}};
  scene.springs = {{{0, 1}, {.stiffness = 100, .rest_length = 1, .quartic = 8}}};
  return scene;
}

double energy_of(const Scene& scene) {
  const Vec energies = qddot::stiff_energies(scene, scene.nodes);
  BOOST_TEST_REQUIRE(energies.size() == 1);
  return energies[0];
}

// 1/2 100 0.3^2 + 1/4 8 0.3^4.
constexpr double stretch_energy = 4.5 + 0.0162;

}  // namespace

BOOST_AUTO_TEST_CASE(of_two_masses_it_is_their_energy_along_the_spring_but_for_the_common_motion) {
  const Eigen::Vector3d n(5. / 13, 12. / 13, 0), across(-n.y(), n.x(), 0);
  BOOST_TEST(std::abs(energy_of(pair_of({0, 0, 0}, {0, 0, 0})) - stretch_energy) < tolerance);
  // mu = 6/5; velocities across the spring and common ones do not count.
  for (const double common : {0., 3.}) {
    for (const double swing : {0., -2.}) {
      const Eigen::Vector3d rest = common * n + swing * across;
      const double energy = energy_of(pair_of(rest - 0.5 * n, common * n + 1.5 * n));
      BOOST_TEST(std::abs(energy - (stretch_energy + 0.5 * 1.2 * 4)) < 10 * tolerance);
    }
  }
  // All of the kinetic energy counts in the frame of the centre of mass.
  const double v1 = -3, v2 = 2;  // 2 v1 + 3 v2 = 0
  const double kinetic = 0.5 * 2 * v1 * v1 + 0.5 * 3 * v2 * v2;
  BOOST_TEST(std::abs(energy_of(pair_of(v1 * n, v2 * n)) - (stretch_energy + kinetic)) <
             10 * tolerance);
}

BOOST_AUTO_TEST_CASE(a_pinned_end_has_the_inertia_of_a_wall) {
  const Eigen::Vector3d n(5. / 13, 12. / 13, 0);
  Scene scene = pair_of({0, 0, 0}, 2 * n);
  scene.nodes[0].pinned = true;
  BOOST_TEST(std::abs(energy_of(scene) - (stretch_energy + 0.5 * 3 * 4)) < tolerance);
  std::swap(scene.springs[0].nodes[0], scene.springs[0].nodes[1]);
  BOOST_TEST(std::abs(energy_of(scene) - (stretch_energy + 0.5 * 3 * 4)) < tolerance);
  scene.nodes[0].pinned = false;
  scene.nodes[0].mass = 0;  // follows at once
  BOOST_TEST(std::abs(energy_of(scene) - stretch_energy) < tolerance);
}

BOOST_AUTO_TEST_CASE(where_a_spring_has_no_direction_the_relative_velocity_is_along_it) {
  Scene scene = pair_of({0, 0, 0}, {3, 4, 0});
  scene.nodes[1].position = scene.nodes[0].position;
  scene.springs[0].law = {.stiffness = 100};
  BOOST_TEST(std::abs(energy_of(scene) - 0.5 * 1.2 * 25) < tolerance);
  // The limit of ends that are about to pass through each other.
  scene.nodes[1].position += 1e-9 * scene.nodes[1].velocity;
  BOOST_TEST(std::abs(energy_of(scene) - 0.5 * 1.2 * 25) < 1e-6);
}

BOOST_AUTO_TEST_CASE(only_springs_above_the_scenes_bound_are_stiff) {
  Scene scene = pair_of({0, 0, 0}, {0, 0, 0});
  scene.springs.push_back({{0, 1}, {.stiffness = 50, .rest_length = 1}});
  scene.springs.push_back({{1, 0}, {.stiffness = 51, .rest_length = 1.3}});
  BOOST_TEST((stiff_springs(scene) == std::vector<std::size_t>{0, 2}));
  BOOST_TEST(distance(qddot::stiff_energies(scene, scene.nodes), Vec{{stretch_energy, 0}}) <
             tolerance);
  scene.stiff_above.reset();
  BOOST_TEST(stiff_springs(scene).empty());
  BOOST_TEST(qddot::stiff_energies(scene, scene.nodes).size() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
