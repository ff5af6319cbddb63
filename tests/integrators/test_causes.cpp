#include <set>

#include <boost/test/unit_test.hpp>

#include "integrators/sundials/cause.hpp"
#include "tests/fragments.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(causes)

using namespace qddot;

namespace {

using qddot::sundials::Cause;

// Whether the message is "<what happened> at t = ... s: <what to turn> (FLAG...)" of that cause.
bool says(const Run& r, Cause cause, const Method& method) {
  const std::string& text = r.summary.message;
  const std::string begin = std::string(qddot::sundials::what_happened(cause)) + " at t = ";
  const std::string turn = std::string(" s: ") +
                           qddot::sundials::what_to_turn(cause, method.knob == Knob::step_size) +
                           " (";
  return r.summary.outcome == qddot::sundials::outcome_of(cause) && text.starts_with(begin) &&
         text.find(turn) != std::string::npos && text.ends_with(")") &&
         text.find('\n') == std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_cause_has_a_sentence_and_an_outcome_of_its_own_kind) {
  std::set<std::string> sentences;
  const int last = static_cast<int>(Cause::other);
  for (int i = 0; i <= last; ++i) {
    const Cause cause{i};
    sentences.insert(qddot::sundials::what_happened(cause));
    BOOST_TEST((qddot::sundials::outcome_of(cause) != Outcome::reached_end));
    for (const bool is_fixed : {false, true}) {
      BOOST_TEST(std::string(qddot::sundials::what_to_turn(cause, is_fixed)).size() > 10);
    }
  }
  BOOST_TEST(std::ssize(sentences) == last + 1);
  // A knob is named where the method has it.
  for (const Cause cause : {Cause::convergence, Cause::setup}) {
    BOOST_TEST(
        std::string(qddot::sundials::what_to_turn(cause, true)).starts_with("lower --step-size"));
    BOOST_TEST(
        std::string(qddot::sundials::what_to_turn(cause, false)).starts_with("lower --rtol"));
  }
}

BOOST_AUTO_TEST_CASE(a_motion_that_collapses_ends_there_and_fails_the_error_test_of_sundials) {
  // f = -1/q^2 draws a mass to 0 in finite time, where there is no motion any more.
  const Problem p = Oscillator().problem();
  const auto system = make_mass_spring(p.network);
  Relay relay(*system);
  relay.after_force = [](const ConstVec& q, MutableVec f) {
    f[0] = q[0] > 0 ? -1 / (q[0] * q[0]) : NAN;
  };
  relay.after_stiffness = [](const Vec& q, SymmetricMatrix& k) {
    k.coeffRef(0, 0) = 2 / (q[0] * q[0] * q[0]);
  };
  int failed_tests = 0;
  for (const Method& method : methods_of(Knob::rtol)) {
    if (method.asks(Need::potential)) continue;  // which is not that of this force
    BOOST_TEST_CONTEXT(method.name) {
      const Run r = run(method, relay, p.initial, 10, {.rtol = 1e-6});
      BOOST_TEST(name(r.summary.outcome) != "reached_end");
      BOOST_TEST(r.summary.message != "");
      BOOST_TEST(is_finite(r.state));
      BOOST_TEST(r.state.q[0] > 0);
      BOOST_TEST(r.state.t < 1);
      if (method.family != Family::sundials) continue;
      failed_tests += says(r, Cause::error_test, method);
      // Some follow it up to a speed that is none, and an explicit method may step beyond 0 and is
      // not allowed another try.
      BOOST_TEST((says(r, Cause::error_test, method) || says(r, Cause::force, method) ||
                  r.summary.outcome == Outcome::diverged),
                 r.summary.message);
    }
  }
  BOOST_TEST(failed_tests >= 8);
}

BOOST_DATA_TEST_CASE(a_long_step_on_a_strongly_nonlinear_scene_does_not_converge,
                     methods_of(Family::sundials, Knob::step_size), method) {
  const Problem p = hammock(2);
  const Run r = run(method, p, 100, {.step_size = 10});
  if (method.is(Trait::implicit)) {
    BOOST_TEST(says(r, Cause::convergence, method), r.summary.message);
  } else {
    BOOST_TEST((says(r, Cause::force, method) || r.summary.outcome == Outcome::diverged),
               r.summary.message);
  }
  BOOST_TEST(r.state.t < 100);
}

BOOST_DATA_TEST_CASE(a_tolerance_of_nearly_zero_is_not_called_an_end_too_close,
                     methods_of(Family::sundials, Knob::rtol), method) {
  const Problem p = hammock(2);
  const Run r = run(method, p, 1e-3, {.rtol = 1e-4, .atol = 1e-300});
  BOOST_TEST(!says(r, Cause::end_too_close, method), r.summary.message);
}

BOOST_DATA_TEST_CASE(an_end_below_rounding_is_refused, methods_of(Family::sundials, Knob::rtol),
                     method) {
  Problem p = hammock(2);
  p.initial.t = 1e9;
  const double t_end = std::nextafter(1e9, 2e9);
  const Run r = run(method, p, t_end, {.rtol = 1e-6});
  BOOST_TEST(says(r, Cause::end_too_close, method), r.summary.message);
  BOOST_TEST(same(r.state, p.initial));
}

BOOST_DATA_TEST_CASE(a_force_or_stiffness_that_is_no_number_is_named_from_the_first_on,
                     methods_of(Family::sundials), method) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  // A step has up to 36 forces, and a run of 100 steps at least one in each.
  for (const int first_bad : {1, 90}) {
    BOOST_TEST_CONTEXT(method.name << " from the force " << first_bad << " on") {
      Relay relay(*system);
      relay.after_force = [&, calls = 0](const ConstVec&, MutableVec f) mutable {
        if (++calls >= first_bad) f[0] = NAN;
      };
      const Run r = run(method, relay, p.initial, 1, options_of(method, 0.01, 1e-6));
      BOOST_TEST(says(r, first_bad == 1 ? Cause::first_force : Cause::force, method),
                 r.summary.message);
      for (const char* library : {"ARKODE", "CVODE", "IDA"}) {
        const bool is_its =
            method.summary.find(std::string("SUNDIALS ") + library) != std::string::npos;
        BOOST_TEST(contains(r.summary.message, {std::string("(") + library + " "}) == is_its);
      }
      BOOST_TEST((r.state.t > 0) == (first_bad > 1));
      BOOST_TEST(contains(r.summary.message, {" at t = 0 s: "}) == (first_bad == 1));
    }
  }
  if (!method.is(Trait::implicit)) return;
  Relay relay(*system);
  relay.after_stiffness = [](const Vec&, SymmetricMatrix& k) { k.coeffs().setConstant(NAN); };
  const Run r = run(method, relay, p.initial, 1, options_of(method, 0.01, 1e-6));
  BOOST_TEST((says(r, Cause::convergence, method) || says(r, Cause::force, method)),
             r.summary.message);
  BOOST_TEST(same(r.state, p.initial));
}

BOOST_AUTO_TEST_SUITE_END()
