#include <boost/test/unit_test.hpp>

#include "qddot/integrators/integrator.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(registry)

using namespace qddot;

namespace {

// The derivative of one step, (q, v) -> (q, v), by central differences.
Eigen::MatrixXd step_derivative(const Method& method, const System& system, const State& at,
                                double h) {
  const Index n = system.size();
  const auto map = [&](const Vec& y) -> Vec {
    // Solved to rounding, as differences have to be.
    const Run r = run(method, system, {0, y.head(n), y.tail(n)}, h,
                      {.step_size = h, .solve_tolerance = 1e-13});
    Vec z(2 * n);
    z << r.state.q, r.state.v;
    return z;
  };
  Vec y(2 * n);
  y << at.q, at.v;
  return finite_difference_jacobian(map, y, 1e-4);
}

// The relative defect of the symplectic form dq ^ M dv after a step: |D'SD - S| / |S|, S = [[0, M],
// [-M, 0]].
double symplectic_defect(const Method& method) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  const Index n = system->size();
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  s.topRightCorner(n, n) = system->mass().asDiagonal();
  s.bottomLeftCorner(n, n) = -s.topRightCorner(n, n);
  const Eigen::MatrixXd d = step_derivative(method, *system, p.initial, 0.05);
  return distance(d.transpose() * s * d, s) / system->mass().maxCoeff();
}

}  // namespace

BOOST_DATA_TEST_CASE(names_are_lower_case_and_every_method_says_in_one_line_what_and_whence_it_is,
                     methods(), method) {
  BOOST_TEST(!method.name.empty());
  BOOST_TEST(method.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") ==
             std::string::npos);
  for (const std::string& text : {method.summary, method.source}) {
    BOOST_TEST(!text.empty());
    BOOST_TEST(text.find('\n') == std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(find_method_finds_each_and_nothing_else) {
  for (const Method& method : methods()) BOOST_TEST(find_method(method.name) == &method);
  for (const char* name : {"", "verle", "verlet ", "Verlet", "verlet2"}) {
    BOOST_TEST(find_method(name) == nullptr);
  }
}

BOOST_AUTO_TEST_CASE(facts_about_a_method_fit_together) {
  for (const Method& method : methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      // Without step error there is no order.
      BOOST_TEST(method.order >= (method.asks(Need::constant_stiffness) ? 0 : 1));
      BOOST_TEST(method.order <= 12);
      // Without implicitness a massless node has no equation; without steps of its own choice a
      // method has no order to choose.
      if (method.is(Trait::accepts_massless)) BOOST_TEST(method.is(Trait::implicit));
      if (method.varies_order() || method.is(Trait::interpolates))
        BOOST_TEST((method.knob == Knob::rtol));
      if (method.is(Trait::reversible) || method.is(Trait::remembers_steps))
        BOOST_TEST((method.knob == Knob::step_size));
      if (method.recurrence_roots) BOOST_TEST(method.is(Trait::remembers_steps));
      if (!method.stock_of.empty()) {
        const Method* own = find_method(method.stock_of);
        BOOST_REQUIRE(own);
        BOOST_TEST(own->stock_of.empty());
        BOOST_TEST(own->order == method.order);
        BOOST_TEST((own->traits == method.traits && own->needs == method.needs));
      }
    }
  }
  // No test asks its questions of nobody.
  for (const auto& list :
       {stock_methods(), methods_with(Option::iterations), methods_with(Option::compensated),
        methods_with(Trait::interpolates), methods_with(Trait::accepts_massless),
        methods_with(Trait::reversible), methods_with(Trait::remembers_steps)}) {
    BOOST_TEST(!list.empty());
  }
  BOOST_TEST(family_name(Family::hand_written) != family_name(Family::sundials));
  BOOST_TEST(knob_name(Knob::step_size) == "step_size");
  BOOST_TEST(knob_name(Knob::rtol) == "rtol");
}

BOOST_AUTO_TEST_CASE(a_summary_before_a_run_says_so) {
  const Summary summary;
  BOOST_TEST(name(summary.outcome) == "solver_failed");
  BOOST_TEST(summary.message == "advance was not called");
}

BOOST_DATA_TEST_CASE(exactly_the_implicit_methods_factorise_and_those_that_need_it_ask_for_k,
                     general_methods(), method) {
  const Problem p = hammock(2);
  const Run r = run(method, p, 0.1, options_of(method, 0.01, 1e-4));
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST((r.summary.counts.stiffness_evaluations > 0) == evaluates_stiffness(method));
  BOOST_TEST((r.summary.counts.factorizations > 0) == method.is(Trait::implicit));
}

BOOST_DATA_TEST_CASE(one_step_keeps_the_symplectic_form_exactly_where_the_registry_says_so,
                     methods_of(Knob::step_size), method) {
  // The first steps of a multistep method are of another kind.
  if (method.recurrence_roots) return;
  const double defect = symplectic_defect(method);
  // Differences with steps s = 1e-4 have errors of s^2 |third derivative|, about 1e-8. Where a
  // method is not symplectic, the defect is some (h w)^(order + 1), with h w = 1 here. At higher
  // orders it is a thousandth of that.
  if (method.is(Trait::symplectic)) {
    BOOST_TEST(defect < 1e-6);
  } else if (method.order < 8) {  // whose defect is below that of the differences
    BOOST_TEST(defect > (method.order == 1 ? 1e-2 : method.order == 2 ? 1e-3 : 1e-5));
  }
}

BOOST_AUTO_TEST_CASE(every_outcome_has_a_name_and_every_failure_its_advice) {
  int count = 0;
  for (Outcome outcome{}; name(outcome) != "unknown"; outcome = static_cast<Outcome>(++count)) {
    BOOST_TEST((find_outcome(name(outcome)) == outcome));  // no other has its name
    BOOST_TEST(advice(outcome).empty() == (outcome == Outcome::reached_end));
  }
  BOOST_TEST(count > 10);
}

BOOST_AUTO_TEST_SUITE_END()
