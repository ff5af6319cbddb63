#include <boost/test/unit_test.hpp>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/linear_motion.hpp"
#include "tests/integrators/scenes.hpp"
#include "tests/integrators/split_relay.hpp"

BOOST_AUTO_TEST_SUITE(imex)

using namespace qddot;

namespace {

// See the suite `sundials`. Where all springs are stiff, so that the implicit table works alone,
// the errors of order 5 come to 330 times the tolerance; else to 150 times.
constexpr double largest_factor = 500;

// The largest error at rtol = 1e-3, 1e-5, 1e-7, 1e-9 as a multiple of rtol. Infinite if a finer
// tolerance does not lower the error, unless the stability limit already forced the steps of the
// coarser one.
double worst_factor(const Method& method, const System& system, const State& start,
                    const State& end) {
  double worst = 0, last = INFINITY;
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const Run r = run(method, system, start, end.t, {.rtol = rtol});
    BOOST_TEST(r.summary.message == "");
    const double error = distance(r.state, end);
    worst = error < last ? std::max(worst, error / rtol) : INFINITY;
    const Counts& c = r.summary.counts;
    last = 2 * c.stability_limited_steps > c.steps ? INFINITY : error;
  }
  return worst;
}

void check_accuracy(const System& system, const State& start, const State& end) {
  for (const Method& method : split_methods_of(Knob::rtol)) {
    BOOST_TEST(worst_factor(method, system, start, end) < largest_factor, method.name);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(linear_networks_are_as_exact_as_the_tolerance_asks) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = linear_hammock(dimension);
    const auto system = make_mass_spring(with_split(p.network));
    check_accuracy(*system, p.initial, LinearMotion(*system).after(p.initial, 1));
  }
}

BOOST_AUTO_TEST_CASE(nonlinear_networks_are_as_exact_as_the_tolerance_asks) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = hammock(dimension);
    const auto system = make_mass_spring(with_split(p.network));
    check_accuracy(*system, p.initial, by_kahan_li(*system, p.initial, 1));
  }
}

BOOST_AUTO_TEST_CASE(either_set_of_springs_may_be_empty) {
  const Problem p = hammock(2);
  for (const bool stiff : {true, false}) {
    const auto system = make_mass_spring(with_all_named(p.network, stiff));
    check_accuracy(*system, p.initial, by_kahan_li(*system, p.initial, 1));
  }
}

BOOST_AUTO_TEST_CASE(a_force_wrong_by_a_thousandth_in_either_half_is_noticed) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  const State end = by_kahan_li(*system, p.initial, 1);
  for (const bool in_stiff : {true, false}) {
    SplitRelay wrong(*system);
    (in_stiff ? wrong.stiff : wrong.soft)->after_force = [](const ConstVec&, MutableVec f) {
      f *= 1.001;
    };
    for (const Method& method : split_methods_of(Knob::rtol)) {
      BOOST_TEST(worst_factor(method, wrong, p.initial, end) > largest_factor, method.name);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_steps_show_the_order_of_the_tables) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  const State end = by_kahan_li(*system, p.initial, 1);
  for (const Method& method : split_methods_of(Knob::rtol)) {
    const double order = order_by_tolerance(method, *system, p.initial, end, 1e-7);
    // See the suite `sundials`.
    BOOST_TEST(std::abs(order - method.order) < 0.2, method.name << " shows " << order);
  }
}

BOOST_AUTO_TEST_CASE(newtons_matrix_is_that_of_the_stiff_springs_alone) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  for (const Method& method : split_methods_of(Knob::rtol)) {
    BOOST_TEST_CONTEXT(method.name) {
      SplitRelay relay(*system);
      Asked asked;
      count_into(asked, relay);
      const Run r = run(method, relay, p.initial, 1, {.rtol = 1e-5});
      const Counts& c = r.summary.counts;
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(asked.stiff_stiffness > 0);
      BOOST_TEST(asked.stiff_stiffness + asked.soft_stiffness == c.stiffness_evaluations);
      // K of the soft springs is only for the stability limit, once in fifty steps.
      BOOST_TEST(asked.soft_stiffness == (c.steps + c.rejected + 49) / 50);
      BOOST_TEST(asked.whole_stiffness == 0);
      // Each force is that of one half, the soft one once a stage and none for Newton's iterations.
      BOOST_TEST(asked.stiff_force + asked.soft_force == c.force_evaluations);
      BOOST_TEST(asked.whole_force == 0);
      BOOST_TEST(asked.soft_force < asked.stiff_force);
    }
  }
}

BOOST_AUTO_TEST_CASE(its_matrix_has_fewer_entries_than_that_of_all_springs) {
  const ReducedScene scene = framed_cloth(6);
  const auto& all = scene.system().stiffness_pattern();
  const auto& stiff = split_of(scene.system())->stiff->stiffness_pattern();
  // Twenty of 36 nodes are on the border, each coupled with two of its up to twelve neighbours.
  BOOST_TEST(3 * stiff.nonZeros() < all.nonZeros());
}

BOOST_AUTO_TEST_CASE(a_frame_ten_thousand_times_stiffer_does_not_bound_the_steps) {
  const ReducedScene scene = framed_cloth(6);
  const double until = 0.1;
  // Verlet's h < 2/w_max: no explicit method goes further with a force.
  const double explicit_steps = until * frequency_bound(scene.system(), scene.initial().q) / 2;
  for (const Method& method : split_methods_of(Knob::rtol)) {
    const Run r = run(method, scene.system(), scene.initial(), until, {.rtol = 1e-3});
    BOOST_TEST(r.summary.message == "");
    BOOST_TEST(10 * r.summary.counts.steps < explicit_steps,
               method.name << ": " << r.summary.counts << " against " << explicit_steps);
  }
}

BOOST_AUTO_TEST_SUITE_END()
