#include <boost/test/unit_test.hpp>

#include "qddot/analysis/largest_frequency.hpp"
#include "tests/integrators/motions.hpp"

BOOST_AUTO_TEST_SUITE(mri)

using namespace qddot;

namespace {

std::vector<Method> mri_methods() {
  return {method_named("arkode_mri3"), method_named("arkode_mri4")};
}

}  // namespace

BOOST_AUTO_TEST_CASE(soft_forces_are_evaluated_a_few_times_a_step_and_stiff_ones_m_times_more) {
  for (const double ratio : {1.0, 100.0, 1e4}) {
    const Problem p = railed_hammock(ratio);
    const auto system = make_mass_spring(p.network);
    const Split& split = *split_of(*system);
    const double m = std::ceil(frequency_bound(*split.stiff, p.initial.q) /
                               frequency_bound(*split.soft, p.initial.q));
    // Stages of the slow and of the fast table.
    for (const auto& [name, slow, fast] :
         {std::tuple("arkode_mri3", 3, 4), {"arkode_mri4", 5, 5}}) {
      Relay relay(*system);
      const Asked whole(relay), stiff(*relay.stiff), soft(*relay.soft);
      const Run r = run(method_named(name), relay, p.initial, 0.2, {.step_size = 0.01});
      BOOST_TEST_CONTEXT(name << " with m = " << m << ": " << soft.force << " soft, " << stiff.force
                              << " stiff") {
        BOOST_TEST(r.summary.message == "");
        const double steps = 20;
        BOOST_TEST(r.summary.counts.steps == steps);
        BOOST_TEST(r.summary.counts.force_evaluations == soft.force + stiff.force);
        BOOST_TEST(whole.force == 0);
        // One evaluation at the start, beside those of the stages.
        BOOST_TEST(soft.force == slow * steps + 1);
        // Inner steps of h/m go from each stage to the next. ARKODE evaluates one more force at the
        // end of some of them, once a step, and at the start.
        const double small_steps = steps * slow * std::ceil(m / slow);
        BOOST_TEST(stiff.force >= small_steps * fast);
        BOOST_TEST(stiff.force <= small_steps * (fast + 1) + steps + 2);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(steps_far_beyond_what_the_stiff_springs_let_an_explicit_method_take) {
  const Problem p = railed_hammock(1e4);
  const Options options{.step_size = 0.01}, fine{.step_size = 0.0025};
  const auto system = make_mass_spring(p.network);
  BOOST_TEST(options.step_size * frequency_bound(*system, p.initial.q) > 10);
  for (const Method& method : mri_methods()) {
    const Run coarse = run(method, p, 1, options);
    BOOST_TEST(coarse.summary.message == "");
    // Nodes move by metres in 1 s; the time scale of the soft forces is some 0.1 s, ten of the
    // steps.
    BOOST_TEST(distance(coarse.state.q, run(method, p, 1, fine).state.q) < 0.02);
  }
  const Run one = run(method_named("verlet"), p, 1, options);
  BOOST_TEST(name(one.summary.outcome) == "diverged");
}

BOOST_AUTO_TEST_CASE(small_steps_below_rounding_are_refused) {
  for (const double t : {1e9, -1e9}) {
    Problem p = railed_hammock(1e4);  // m = 156
    p.initial.t = t;
    for (const Method& method : mri_methods()) {
      // Times here are 1.2e-7 s apart: h advances them, h/m does not.
      const Run r = run(method, p, t + 1e-3, {.step_size = 1e-5});
      BOOST_TEST(name(r.summary.outcome) == "step_too_small");
      BOOST_TEST(r.summary.message.starts_with(
                     "the small steps of the stiff springs are below rounding at t = "),
                 r.summary.message);
      BOOST_TEST(r.summary.message.find("raise --step-size") != std::string::npos);
      BOOST_TEST(same(r.state, p.initial));
      BOOST_TEST(r.summary.counts.force_evaluations == 0);
      // Larger ones do.
      BOOST_TEST(run(method, p, t + 1e-2, {.step_size = 1e-3}).summary.message == "");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
