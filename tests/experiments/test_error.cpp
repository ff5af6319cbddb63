#include <cmath>

#include <boost/test/unit_test.hpp>

#include "experiments/error.hpp"

using namespace qddot;

namespace {

// Two free nodes of masses 2 and 3 in 3D, a pinned one between them, no springs.
Scene three_nodes() {
  Scene scene{.name = "three"};
  scene.nodes = {{.position = {1, 2, 3}, .mass = 2},
                 {.position = {9, 9, 9}, .pinned = true},
                 {.position = {-1, 0, 0}, .velocity = {0, 1, 0}, .mass = 3}};
  return scene;
}

// So that the unknowns are the coordinates of the free nodes.
const auto plain = Reductions::only({Reduction::pins});

}  // namespace

BOOST_AUTO_TEST_SUITE(error)

BOOST_AUTO_TEST_CASE(errors_are_the_worst_node_over_its_scale) {
  const ReducedScene scene(three_nodes(), plain);
  const State reference = scene.initial();
  State state = reference;
  state.q.head<3>() += Eigen::Vector3d(0.3, 0, 0.4);
  state.q.tail<3>() += Eigen::Vector3d(0, 0.1, 0);
  state.v.tail<3>() += Eigen::Vector3d(0, 2, 0);  // kinetic energy 3/2 (9 - 1) = 12 more
  const Errors errors = errors_between(scene, state, reference, scene.energy(reference),
                                       {.displacement = 2, .speed = 4, .kinetic = 6});
  BOOST_TEST(errors.position == 0.25, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(errors.velocity == 0.5, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(errors.energy == 2, boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(where_a_scale_is_zero_the_error_is_absolute) {
  const ReducedScene scene(three_nodes(), plain);
  const State reference = scene.initial();
  State state = reference;
  state.q[0] += 0.5;
  state.v[0] += 2;
  const Errors errors = errors_between(scene, state, reference, scene.energy(reference), {});
  BOOST_TEST(errors.position == 0.5);
  BOOST_TEST(errors.velocity == 2);
  BOOST_TEST(errors.energy == 4, boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(a_state_has_no_error_against_itself) {
  const ReducedScene scene(three_nodes(), plain);
  const State& state = scene.initial();
  for (const Scales& scales : {Scales{}, Scales{1e-300, 1e-300, 1e-300}}) {
    const Errors errors = errors_between(scene, state, state, scene.energy(state), scales);
    BOOST_TEST(errors.position == 0);
    BOOST_TEST(errors.velocity == 0);
    BOOST_TEST(errors.energy == 0);
  }
}

BOOST_AUTO_TEST_CASE(scales_keep_the_largest_of_all_states) {
  const ReducedScene scene(three_nodes(), plain);
  Scales scales;
  extend(scales, scene, scene.initial());
  BOOST_TEST(scales.displacement == 0);
  BOOST_TEST(scales.speed == 1);
  BOOST_TEST(scales.kinetic == 1.5);
  State far = scene.initial();
  far.q.tail<3>() += Eigen::Vector3d(0, 3, 4);
  far.v.setZero();
  extend(scales, scene, far);
  extend(scales, scene, scene.initial());
  BOOST_TEST(scales.displacement == 5);
  BOOST_TEST(scales.speed == 1);
  BOOST_TEST(scales.kinetic == 1.5);
}

BOOST_AUTO_TEST_CASE(where_all_is_pinned_there_is_no_error) {
  Scene pinned = three_nodes();
  for (Node& node : pinned.nodes) node.pinned = true;
  const ReducedScene scene(pinned);
  Scales scales;
  extend(scales, scene, scene.initial());
  BOOST_TEST(scales.displacement == 0);
  const Errors errors = errors_between(scene, scene.initial(), scene.initial(), 0, scales);
  BOOST_TEST(errors.position == 0);
  BOOST_TEST(errors.velocity == 0);
}

BOOST_AUTO_TEST_CASE(negative_control_one_rounding_shows) {
  const ReducedScene scene(three_nodes(), plain);
  State state = scene.initial();
  state.q[0] = std::nextafter(state.q[0], 2);
  const Errors errors = errors_between(scene, state, scene.initial(), 0, {});
  BOOST_TEST(errors.position > 0);
  BOOST_TEST(errors.velocity == 0);
}

BOOST_AUTO_TEST_SUITE_END()
