#include <boost/test/unit_test.hpp>

#include "qddot/analysis/largest_frequency.hpp"
#include "tests/integrators/split_relay.hpp"

BOOST_AUTO_TEST_SUITE(mri)

using namespace qddot;

namespace {

std::vector<Method> mri_methods() {
  return {method_named("arkode_mri3"), method_named("arkode_mri4")};
}

// The hammock released from rest. Its springs along the row are `ratio` times stiffer, at their
// drawn length, and named stiff; braces and anchors are soft.
Problem railed_hammock(int dimension, double ratio) {
  Problem p = hammock(dimension);
  const auto at = [&](int i) { return p.initial.q.segment(dimension * i, dimension); };
  for (int e = 0; e < 3; ++e) {
    auto& link = p.network.links[static_cast<std::size_t>(e)];
    link.stiff = true;
    link.law = {.stiffness = 60 * ratio, .rest_length = (at(link.i) - at(link.j)).norm()};
  }
  p.initial.v.setZero();
  p.network.offers_split = true;
  return p;
}

// The orders seen in q and v over four halvings of a step of 1/`steps` s.
Orders observed_orders(const Method& method, const System& system, const State& start,
                       const State& end, int steps) {
  std::vector<double> q, v;
  for (int halving = 0; halving <= 4; ++halving, steps *= 2) {
    const Run r = run(method, system, start, end.t, {.step_size = end.t / steps});
    BOOST_TEST(r.summary.message == "");
    q.push_back(distance(r.state.q, end.q));
    v.push_back(distance(r.state.v, end.v));
  }
  return {observed_order(q), observed_order(v)};
}

bool is_of_order(int p, const Orders& observed) {
  return std::abs(observed.q - p) <= 0.15 && std::abs(observed.v - p) <= 0.15;
}

// Rounding is reached after, and the first term of the error rules from, so many steps a second.
constexpr int coarsest = 40;

void check_orders(const System& system, const State& start) {
  const State end = by_kahan_li(system, start, 1);
  for (const Method& method : mri_methods()) {
    const Orders observed = observed_orders(method, system, start, end, coarsest);
    BOOST_TEST_CONTEXT(method.name << " in q " << observed.q << ", in v " << observed.v) {
      BOOST_TEST(is_of_order(method.order, observed));
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(both_have_their_orders_on_nonlinear_networks) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = hammock(dimension);
    check_orders(*make_mass_spring(with_split(p.network)), p.initial);
  }
}

BOOST_AUTO_TEST_CASE(both_have_their_orders_with_many_small_steps_inside) {
  const Problem p = railed_hammock(2, 20);
  check_orders(*make_mass_spring(p.network), p.initial);
}

BOOST_AUTO_TEST_CASE(either_set_of_springs_may_be_empty) {
  const Problem p = hammock(2);
  for (const bool stiff : {true, false}) {
    check_orders(*make_mass_spring(with_all_named(p.network, stiff)), p.initial);
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
    for (const Method& method : mri_methods()) {
      const Orders observed = observed_orders(method, wrong, p.initial, end, coarsest);
      BOOST_TEST(!is_of_order(method.order, observed), method.name);
    }
  }
}

BOOST_AUTO_TEST_CASE(soft_forces_are_evaluated_a_few_times_a_step_and_stiff_ones_m_times_more) {
  for (const double ratio : {1.0, 100.0, 1e4}) {
    const Problem p = railed_hammock(2, ratio);
    const auto system = make_mass_spring(p.network);
    const Split& split = *split_of(*system);
    const double m = std::ceil(frequency_bound(*split.stiff, p.initial.q) /
                               frequency_bound(*split.soft, p.initial.q));
    // Stages of the slow and of the fast table.
    for (const auto& [name, slow, fast] :
         {std::tuple("arkode_mri3", 3, 4), {"arkode_mri4", 5, 5}}) {
      SplitRelay relay(*system);
      Asked asked;
      count_into(asked, relay);
      const Run r = run(method_named(name), relay, p.initial, 0.2, {.step_size = 0.01});
      BOOST_TEST_CONTEXT(name << " with m = " << m << ": " << asked.soft_force << " soft, "
                              << asked.stiff_force << " stiff") {
        BOOST_TEST(r.summary.message == "");
        const double steps = 20;
        BOOST_TEST(r.summary.counts.steps == steps);
        BOOST_TEST(r.summary.counts.force_evaluations == asked.soft_force + asked.stiff_force);
        BOOST_TEST(asked.whole_force == 0);
        // One evaluation at the start, beside those of the stages.
        BOOST_TEST(asked.soft_force == slow * steps + 1);
        // Inner steps of h/m go from each stage to the next. ARKODE evaluates one more force at the
        // end of some of them, once a step, and at the start.
        const double small_steps = steps * slow * std::ceil(m / slow);
        BOOST_TEST(asked.stiff_force >= small_steps * fast);
        BOOST_TEST(asked.stiff_force <= small_steps * (fast + 1) + steps + 2);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(steps_far_beyond_what_the_stiff_springs_let_an_explicit_method_take) {
  const Problem p = railed_hammock(2, 1e4);
  const auto system = make_mass_spring(p.network);
  const Options options{.step_size = 0.01}, fine{.step_size = 0.0025};
  BOOST_TEST(options.step_size * frequency_bound(*system, p.initial.q) > 10);
  for (const Method& method : mri_methods()) {
    const Run coarse = run(method, *system, p.initial, 1, options);
    BOOST_TEST(coarse.summary.message == "");
    // Nodes move by metres in 1 s; the time scale of the soft forces is some 0.1 s, ten of the
    // steps.
    BOOST_TEST(distance(coarse.state.q, run(method, *system, p.initial, 1, fine).state.q) < 0.02);
  }
  const Run one = run(method_named("verlet"), *system, p.initial, 1, options);
  BOOST_TEST(name(one.summary.outcome) == "diverged");
}

BOOST_AUTO_TEST_CASE(small_steps_below_rounding_are_refused) {
  for (const double t : {1e9, -1e9}) {
    Problem p = railed_hammock(2, 1e4);  // m = 156
    p.initial.t = t;
    const auto system = make_mass_spring(p.network);
    for (const Method& method : mri_methods()) {
      // Times here are 1.2e-7 s apart: h advances them, h/m does not.
      const Run r = run(method, *system, p.initial, t + 1e-3, {.step_size = 1e-5});
      BOOST_TEST(name(r.summary.outcome) == "step_too_small");
      BOOST_TEST(r.summary.message.starts_with(
                     "the small steps of the stiff springs are below rounding at t = "),
                 r.summary.message);
      BOOST_TEST(r.summary.message.find("raise --step-size") != std::string::npos);
      BOOST_TEST(same(r.state, p.initial));
      BOOST_TEST(r.summary.counts.force_evaluations == 0);
      // Larger ones do.
      BOOST_TEST(run(method, *system, p.initial, t + 1e-2, {.step_size = 1e-3}).summary.message ==
                 "");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
