// Methods that take the forces of stiff springs apart.
#include <boost/test/unit_test.hpp>

#include "integrators/sundials/version.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "tests/integrators/motions.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(split_steps)

using namespace qddot;

namespace {

std::vector<Method> pairs() {
  return methods_where(
      [](const Method& m) { return m.asks(Need::split_forces) && m.knob == Knob::rtol; });
}

// The evaluations of soft and of stiff forces.
std::pair<std::int64_t, std::int64_t> forces_of_20_steps(const char* method, const Problem& p) {
  const auto system = make_mass_spring(p.network);
  Relay relay(*system);
  const Asked whole(relay), stiff(*relay.stiff), soft(*relay.soft);
  const Run r = run(method_named(method), relay, p.initial, 0.2, {.step_size = 0.01});
  BOOST_TEST(r.summary.message == "", method);
  BOOST_TEST(r.summary.counts.steps == 20);
  BOOST_TEST(r.summary.counts.force_evaluations == soft.force + stiff.force);
  BOOST_TEST(whole.force == 0);
  return {soft.force, stiff.force};
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

BOOST_AUTO_TEST_CASE(a_stiff_frame_leaves_steps_as_long_as_the_cloths_own) {
  const Model scene = framed_cloth(8);
  const auto run_by = [&](const char* method, double h) {
    return run(method_named(method), scene.system(), scene.initial(), 0.05, {.step_size = h});
  };
  // Verlet is stable up to about 3e-5 s. The frame swings by some 1e-2 m.
  const Vec exact = run_by("kahan_li8", 1e-5).state.q;
  BOOST_TEST(name(run_by("verlet", 5e-4).summary.outcome) == "diverged");
  for (const auto& [method, h, most] : {std::tuple("multirate_adams2", 1e-3, 1e-5),
                                        {"multirate_adams4", 1e-3, 1e-6},
                                        {"multirate_adams5", 5e-4, 1e-8},
                                        {"arkode_mri3", 5e-4, 1e-5},
                                        {"arkode_mri4", 5e-4, 1e-5}}) {
    const Run r = run_by(method, h);
    BOOST_TEST(r.summary.message == "");
    BOOST_TEST(distance(r.state.q, exact) < most, method);
  }
}

BOOST_AUTO_TEST_CASE(soft_forces_are_evaluated_a_few_times_a_step_and_stiff_ones_m_times_more) {
  for (const double ratio : {1.0, 100.0, 1e4}) {
    const Problem p = railed_hammock(ratio);
    const auto system = make_mass_spring(p.network);
    const Split& split = *system->split();
    const double m = std::ceil(frequency_bound(*split.stiff, p.initial.q) /
                               frequency_bound(*split.soft, p.initial.q));
    // Stages of the slow and of the fast table. From SUNDIALS 7.1 on, the last stage of the fast
    // table of order 3 is the first one of the next step, and no soft force is evaluated at the
    // start beside those of the stages.
    constexpr bool is_saving = QDDOT_SUNDIALS >= 70100;
    for (const auto& [name, slow, fast] :
         {std::tuple("arkode_mri3", 3, is_saving ? 3 : 4), {"arkode_mri4", 5, 5}}) {
      const auto [soft, stiff] = forces_of_20_steps(name, p);
      BOOST_TEST_CONTEXT(name << " with m = " << m << ": " << soft << " soft, " << stiff
                              << " stiff") {
        BOOST_TEST(soft == slow * 20 + (is_saving ? 0 : 1));
        // Inner steps of h/m go from each stage to the next. ARKODE evaluates one more force at the
        // end of some of them, once a step, and at the start.
        const double small_steps = 20 * slow * std::ceil(m / slow);
        BOOST_TEST(stiff >= small_steps * fast);
        BOOST_TEST(stiff <= small_steps * (fast + 1) + 20 + 2);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(small_steps_below_rounding_are_refused) {
  for (const double t : {1e9, -1e9}) {
    Problem p = railed_hammock(1e4);  // m = 156
    p.initial.t = t;
    for (const char* name_of_method : {"arkode_mri3", "arkode_mri4"}) {
      const Method& method = method_named(name_of_method);
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
  const Problem p{with_split(hammock(2).network), hammock(2).initial};
  // Forces besides one a step: one of the start, and those of the first step. It has k - 1 parts,
  // done twice at k = 3 and three times at k = 4; one of these forces is the step's own.
  for (const auto& [name, at_start] :
       {std::pair("multirate_adams2", 1), {"multirate_adams4", 4}, {"multirate_adams5", 9}}) {
    const auto [soft, stiff] = forces_of_20_steps(name, p);
    BOOST_TEST(soft == 20 + at_start, name);
    BOOST_TEST(stiff >= 20, name);
  }
}

BOOST_AUTO_TEST_SUITE_END()
