#include <boost/test/unit_test.hpp>

#include "qddot/analysis/largest_frequency.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(imex)

using namespace qddot;

namespace {

std::vector<Method> pairs() {
  return methods_where([](const Method& method) {
    return method.asks(Need::split_forces) && method.knob == Knob::rtol;
  });
}

}  // namespace

BOOST_DATA_TEST_CASE(newtons_matrix_is_that_of_the_stiff_springs_alone, pairs(), method) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  Relay relay(*system);
  const Asked whole(relay), stiff(*relay.stiff), soft(*relay.soft);
  const Run r = run(method, relay, p.initial, 1, {.rtol = 1e-5});
  const Counts& c = r.summary.counts;
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(stiff.stiffness > 0);
  BOOST_TEST(stiff.stiffness + soft.stiffness == c.stiffness_evaluations);
  // K of the soft springs is only for the stability limit, once in fifty steps.
  BOOST_TEST(soft.stiffness == (c.steps + c.rejected + 49) / 50);
  BOOST_TEST(whole.stiffness == 0);
  // Each force is that of one half, the soft one once a stage and none for Newton's iterations.
  BOOST_TEST(stiff.force + soft.force == c.force_evaluations);
  BOOST_TEST(whole.force == 0);
  BOOST_TEST(soft.force < stiff.force);
}

BOOST_TEST(3 * stiff.nonZeros() < all.nonZeros());
}

BOOST_DATA_TEST_CASE(a_frame_ten_thousand_times_stiffer_does_not_bound_the_steps, pairs(), method) {
  const ReducedScene scene = framed_cloth(6);
  const double until = 0.1;
  // Verlet's h < 2/w_max: no explicit method goes further with a force.
  const double explicit_steps = until * frequency_bound(scene.system(), scene.initial().q) / 2;
  const Run r = run(method, scene.system(), scene.initial(), until, {.rtol = 1e-3});
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(10 * r.summary.counts.steps < explicit_steps,
             method.name << ": " << r.summary.counts << " against " << explicit_steps);
}

BOOST_AUTO_TEST_SUITE_END()
