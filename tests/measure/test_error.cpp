#include <cmath>
#include <limits>
#include <memory>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/error.hpp"
#include "qddot/scene/reduce/part.hpp"
#include "tests/integrators/own_system.hpp"

BOOST_AUTO_TEST_SUITE(error)

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

// Two oscillators of 1 kg on 1 N/m and 1 m that no spring joins, drawn at 2 m and at `second`, with
// pins at 0 and 5 m.
Scene two_oscillators(double second) {
  Scene scene{.name = "two", .dimension = 1};
  scene.nodes = {{.pinned = true},
                 {.position = {2, 0, 0}, .mass = 1},
                 {.position = {5, 0, 0}, .pinned = true},
                 {.position = {second, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 1, .rest_length = 1}},
                   {{2, 3}, {.stiffness = 1, .rest_length = 1}}};
  return scene;
}

// With these reductions the unknowns are the coordinates of the free nodes.
const auto plain = Reductions::only({Reduction::pins});

}  // namespace

BOOST_AUTO_TEST_CASE(errors_are_the_worst_node_over_its_scale) {
  const Model scene(three_nodes(), plain);
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
  const Model scene(three_nodes(), plain);
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
  const Model scene(three_nodes(), plain);
  const State& state = scene.initial();
  for (const Scales& scales : {Scales{}, Scales{1e-300, 1e-300, 1e-300}}) {
    const Errors errors = errors_between(scene, state, state, scene.energy(state), scales);
    BOOST_TEST((errors.position == 0 && errors.velocity == 0 && errors.energy == 0));
  }
}

BOOST_AUTO_TEST_CASE(scales_keep_the_largest_of_all_states) {
  const Model scene(three_nodes(), plain);
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

BOOST_AUTO_TEST_CASE(each_part_is_measured_by_its_own_motion) {
  // One of amplitude 1 m and one of 1e-10 m.
  const Model two(two_oscillators(6 + 1e-10));
  BOOST_TEST_REQUIRE(two.parts().size() == 2u);
  const State start = two.initial();
  State swung = start;
  swung.q -= Vec{{2, 2e-10}};
  swung.v = Vec{{-1, -1e-10}};
  Scales scales;
  extend(scales, two, start);
  extend(scales, two, swung);
  BOOST_TEST(scales.displacement == 2);
  BOOST_TEST(scales.speed == 1);
  // A rounding of the coordinate 6 is 4e-6 of 2e-10.
  const auto off = [&](double large, double small) {
    State state = start;
    state.q += Vec{{large, small}};
    return errors_between(two, state, start, 0, scales).position;
  };
  BOOST_TEST(off(2e-3, 0) == 1e-3, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(off(0, 2e-11) == 0.1, boost::test_tools::tolerance(1e-4));
  BOOST_TEST(off(2e-3, 2e-11) == 0.1, boost::test_tools::tolerance(1e-4));
  State fast = start;
  fast.v = Vec{{0, 1e-11}};
  BOOST_TEST(errors_between(two, fast, start, 0, scales).velocity == 0.1,
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(positions_alone_have_the_same_error) {
  const Model two(two_oscillators(6));
  State swung = two.initial(), off = two.initial();
  swung.q += Vec{{1, 1e-3}};
  off.q += Vec{{1e-3, -2e-5}};
  Scales scales;
  extend(scales, two, two.initial());
  extend(scales, two, swung);
  const double error = errors_between(two, off, two.initial(), 0, scales).position;
  BOOST_TEST(error == 2e-2, boost::test_tools::tolerance(1e-9));  // of the second part
  BOOST_TEST(position_error(two, off, two.initial(), scales) == error,
             boost::test_tools::tolerance(1e-9));
  off.q[1] = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(std::isnan(position_error(two, off, two.initial(), scales)));
  std::swap(off.q[0], off.q[1]);
  BOOST_TEST(std::isnan(position_error(two, off, two.initial(), scales)));
  BOOST_TEST(std::isnan(errors_between(two, off, two.initial(), 0, scales).position));
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_no_small_error_of_an_own_system) {
  const auto system = std::make_shared<const ChainWithStiffness>();
  const Index n = system->size();
  const Model own(system, {0, Vec::Zero(n), Vec::Zero(n)}, 1);
  Scales scales;
  State off = own.initial();
  off.q.setOnes();
  extend(scales, own, own.initial());
  extend(scales, own, off);
  BOOST_TEST(position_error(own, off, own.initial(), scales) == 1);
  for (Index i = 0; i < n; ++i) {
    State lost = off;
    lost.q[i] = std::numeric_limits<double>::quiet_NaN();
    BOOST_TEST(std::isnan(position_error(own, lost, own.initial(), scales)), "unknown " << i);
  }
}

BOOST_AUTO_TEST_CASE(a_part_that_only_rounds_is_measured_by_the_others) {
  const Model two(two_oscillators(6));
  State state = two.initial();
  state.q += Vec{{1, 1e-15}};
  Scales scales;
  extend(scales, two, two.initial());
  extend(scales, two, state);
  BOOST_TEST((!scales.parts[0].is_at_rest() && scales.parts[1].is_at_rest()));
  State rounded = two.initial();
  rounded.q[1] += 8 * 0x1p-52;  // a rounding or two of its place at 6 m
  const double error = errors_between(two, rounded, two.initial(), 0, scales).position;
  BOOST_TEST((error > 0 && error < 1e-14));
}

BOOST_AUTO_TEST_CASE(free_flight_is_no_scale_of_what_swings) {
  Scene scene{.name = "thrown", .dimension = 1};
  scene.nodes = {
      {.pinned = true}, {.position = {2, 0, 0}, .mass = 1}, {.velocity = {1e6, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 1, .rest_length = 1}}};
  const Model thrown(scene);
  State later = thrown.initial();
  later.t = 1;
  later.q[0] -= 0.5;
  Scales scales;
  extend(scales, thrown, later);
  BOOST_TEST(scales.displacement == 0.5);
  // But where nothing else moves.
  scene.springs.clear();
  const Model alone(scene);
  State flown = alone.initial();
  flown.t = 1;
  Scales of_flight;
  extend(of_flight, alone, flown);
  BOOST_TEST(of_flight.displacement == 1e6);
}

BOOST_AUTO_TEST_CASE(where_all_is_pinned_there_is_no_error) {
  Scene pinned = three_nodes();
  for (Node& node : pinned.nodes) node.pinned = true;
  const Model scene(pinned);
  Scales scales;
  extend(scales, scene, scene.initial());
  BOOST_TEST(scales.displacement == 0);
  const Errors errors = errors_between(scene, scene.initial(), scene.initial(), 0, scales);
  BOOST_TEST(errors.position == 0);
  BOOST_TEST(errors.velocity == 0);
}

BOOST_AUTO_TEST_SUITE_END()
