#include <boost/test/unit_test.hpp>

#include "tests/integrators/motions.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(multirate_adams)

using namespace qddot;

namespace {

std::vector<Method> multirate_methods() {
  return {method_named("multirate_adams2"), method_named("multirate_adams4"),
          method_named("multirate_adams5")};
}

// The largest distance of a node at the end, between two runs of a framed cloth of 8 x 8 nodes.
double difference(const ReducedScene& scene, const Method& method, double h, const State& end) {
  const Run r = run(method, scene.system(), scene.initial(), end.t, {.step_size = h});
  BOOST_TEST(r.summary.message == "");
  return (r.state.q - end.q).lpNorm<Eigen::Infinity>();
}

}  // namespace

BOOST_DATA_TEST_CASE(without_soft_springs_only_the_short_steps_err, multirate_methods(), method) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_all_named(p.network, true));
  const State end = KnownMotion("hammock", p).end;
  const auto error = [&](double h) {
    return distance(run(method, *system, p.initial, 1, {.step_size = h}).state.q, end.q);
  };
  // Two halvings. Short steps become more in a step by whole numbers, at order 5 by none here.
  const double order = std::log2(error(1. / 40) / error(1. / 160)) / 2;
  BOOST_TEST(order > std::min(method.order, 4) - 0.5, method.name << ": " << order);
}

BOOST_AUTO_TEST_CASE(without_stiff_springs_order_2_is_velocity_verlet) {
  const Problem p = hammock(3);
  const auto soft = make_mass_spring(with_all_named(p.network, false));
  const Options options{.step_size = 0.01};
  const Run own = run(method_named("multirate_adams2"), *soft, p.initial, 1, options);
  const Run verlet = run(method_named("verlet"), p, 1, options);
  // 100 steps of positions and velocities of some metres, each rounded.
  BOOST_TEST(distance(own.state, verlet.state) < 100 * 10 * 2.2e-16 * 10);
}

BOOST_AUTO_TEST_CASE(a_step_takes_one_soft_force_and_stiff_ones_of_short_steps) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  // Forces besides one a step: one of the start, and those of the first step. It has k - 1 parts,
  // done twice at k = 3 and three times at k = 4; one of these forces is the step's own.
  for (const auto& [name, at_start] :
       {std::pair("multirate_adams2", 1), {"multirate_adams4", 4}, {"multirate_adams5", 9}}) {
    Relay relay(*system);
    const Asked whole(relay), stiff(*relay.stiff), soft(*relay.soft);
    const Run r = run(method_named(name), relay, p.initial, 0.2, {.step_size = 0.01});
    BOOST_TEST_CONTEXT(name) {
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(soft.force == 20 + at_start);
      BOOST_TEST(whole.force == 0);
      BOOST_TEST(stiff.force >= 20);
      BOOST_TEST(r.summary.counts.force_evaluations == soft.force + stiff.force);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_stiff_frame_leaves_steps_as_long_as_the_cloths_own) {
  const ReducedScene scene = framed_cloth(8);
  const double until = 0.05;
  const State end =
      run(method_named("kahan_li8"), scene.system(), scene.initial(), until, {.step_size = 1e-5})
          .state;
  // Verlet is stable up to about 3e-5 s. The frame swings by some 1e-2 m.
  const double h = 1e-3;
  BOOST_TEST(difference(scene, method_named("multirate_adams2"), h, end) < 1e-5);
  BOOST_TEST(difference(scene, method_named("multirate_adams4"), h, end) < 1e-6);
  BOOST_TEST(difference(scene, method_named("multirate_adams5"), h / 2, end) < 1e-8);
  const Run verlet =
      run(method_named("verlet"), scene.system(), scene.initial(), until, {.step_size = h});
  BOOST_TEST(name(verlet.summary.outcome) == "diverged");
}

BOOST_AUTO_TEST_SUITE_END()
