// Orders of methods, and errors of those that choose their steps as multiples of the tolerance.
#include <boost/numeric/odeint.hpp>
#include <boost/test/unit_test.hpp>

#include "tests/integrators/motions.hpp"

BOOST_AUTO_TEST_SUITE(order)

using namespace qddot;

namespace {

// Errors of the end below these are rounding (some 1e-14 m and 1e-13 m/s), not truncation.
constexpr double floor_q = 1e-13, floor_v = 1e-12;

// The same motion by an explicit Runge-Kutta method of the first-order form, which shares nothing
// with the methods under test.
State by_fehlberg(const KnownMotion& motion) {
  using Y = std::vector<double>;
  namespace odeint = boost::numeric::odeint;
  const System& system = *motion.system;
  const Index n = system.size();
  Y y(motion.start.q.begin(), motion.start.q.end());
  y.insert(y.end(), motion.start.v.begin(), motion.start.v.end());
  const auto rate = [&](const Y& at, Y& change, double) {
    change.assign(at.begin() + n, at.end());
    const Vec f = force_at(system, Eigen::Map<const Vec>(at.data(), n));
    for (Index i = 0; i < n; ++i) change.push_back(f[i] / system.mass()[i]);
  };
  const auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<Y>>(1e-15, 1e-15);
  odeint::integrate_adaptive(stepper, rate, y, 0.0, motion.end.t, 1e-3);
  return {motion.end.t, Eigen::Map<Vec>(y.data(), n), Eigen::Map<Vec>(y.data() + n, n)};
}

std::vector<Method> of_fixed_steps() {
  return methods_where([](const Method& m) { return m.knob == Knob::step_size && m.order > 0; });
}
std::vector<Method> of_chosen_steps() {
  return methods_where([](const Method& m) {
    return m.knob == Knob::rtol && !m.varies_order() && m.order < 12;  // which takes too few
  });
}

constexpr int usual_halvings = 9, most_halvings = 12;

// The numbers of steps that are tried, one after the other. Order 1 needs the most steps, until its
// higher terms (h w / 2 of it) do not matter; those of order 2 are their squares. Multistep methods
// need more steps than they begin with. Errors of an order from 8 on soon are so small that
// halvings would leave too few.
std::vector<int> step_counts(const Method& method, const KnownMotion& motion, int halvings) {
  std::vector<int> list;
  if (method.recurrence_roots) {
    for (double steps = 6 * method.order; steps < 6 << halvings; steps *= 1.15) {
      list.push_back(static_cast<int>(steps));
    }
  } else if (method.order >= 8) {
    for (double steps = 4; steps < 6 << halvings; steps *= 1.25) {
      list.push_back(static_cast<int>(steps));
    }
  } else {
    // In the stiff hammock only small steps inside err, and errors soon are rounding.
    const bool has_both = method.asks(Need::split_forces) && motion.name != "stiff hammock";
    const int first = has_both ? 20 : 6;
    for (int steps = first; steps <= first << halvings; steps *= 2) list.push_back(steps);
  }
  return list;
}

// The orders seen in q and v over the last five numbers of steps before rounding shows; over more
// where these are near each other.
struct Orders {
  double q, v;
};
Orders observed_orders(const Method& method, const KnownMotion& motion, int halvings) {
  const double until = motion.end.t;
  const double roundings = method.asks(Need::split_forces) ? 100 : 1;  // of the small steps inside
  std::vector<double> h, q, v;
  for (const int steps : step_counts(method, motion, halvings)) {
    const Run r = run(method, *motion.system, motion.start, until, {.step_size = until / steps});
    if (!r.summary.message.empty()) {
      BOOST_TEST(steps < 40, r.summary.message);
      continue;
    }
    const double error_q = distance(r.state.q, motion.end.q),
                 error_v = distance(r.state.v, motion.end.v);
    if (error_q < roundings * floor_q || error_v < roundings * floor_v) break;
    h.push_back(std::log(until / steps));
    q.push_back(std::log(error_q));
    v.push_back(std::log(error_v));
  }
  BOOST_REQUIRE(q.size() >= 5);
  const auto last = std::min<Index>(std::ssize(q), method.recurrence_roots ? 10 : 5);
  const auto tail = [last](const std::vector<double>& x) {
    return Vec(Eigen::Map<const Vec>(x.data() + std::ssize(x) - last, last));
  };
  return {slope(tail(h), tail(q)), slope(tail(h), tail(v))};
}

// Few halvings fit between higher terms and rounding at high orders. A multistep method of order 8
// or 10 is at rounding before its higher terms vanish, which make the slope steeper; its order
// conditions are tested exactly elsewhere. Small steps inside a step come in whole numbers, which
// bends the line of errors a little.
bool is_of_order(const Method& method, const Orders& observed) {
  const bool is_high = method.recurrence_roots && method.order >= 8;
  const double most = method.order > 4 ? 0.25 : 0.1;
  const double slack = is_high ? 0.35 : method.asks(Need::split_forces) ? most + 0.05 : most;
  // The error of rk8 begins with a coefficient that is a thousandth of what its order has; the next
  // order shows first.
  const double more = is_high ? 4 : method.name == "rk8" ? 1.1 : slack;
  return std::min(observed.q, observed.v) >= method.order - slack &&
         std::max(observed.q, observed.v) <= method.order + more;
}

// The order p of a method that chooses its steps. If each step is as long as its error allows,
// errors are proportional to steps^-p. Errors of single runs cancel by chance. So p is the slope of
// the line through 13 runs, from the given tolerance to a thousandth of it.
double order_by_tolerance(const Method& method, const KnownMotion& motion, double coarsest_rtol) {
  constexpr int runs = 13;
  Vec steps(runs), error(runs);
  for (int i = 0; i < runs; ++i) {
    const Run r = run(method, *motion.system, motion.start, motion.end.t,
                      {.rtol = coarsest_rtol * std::pow(10, -i / 4.0)});
    steps[i] = std::log(static_cast<double>(r.summary.counts.steps));
    error[i] = std::log(distance(r.state, motion.end));
  }
  return -slope(steps, error);
}

std::vector<Method> adaptive() {
  return methods_where([](const Method& method) { return method.knob == Knob::rtol; });
}

// The tolerance is for the estimated error of each step in the root mean square over q and v. These
// motions last two to three periods. The largest error of any entry is 0.1 to 25 tolerances with
// ARKODE (60 with order 3 at 1e-7, which takes the most steps). It comes to 330 where the implicit
// table of a pair works alone, at order 5. It is up to 1100 with multistep methods, whose order
// rises and falls. A Newton iteration that stops too early gives 1e4 and more.
double largest_factor(const Method& method) {
  return method.varies_order() ? 2000 : method.asks(Need::split_forces) ? 500 : 100;
}

// The largest error at rtol = 1e-3, 1e-5, 1e-7, 1e-9 as a multiple of rtol. Infinite if a finer
// tolerance does not lower the error, unless the stability limit already forced the steps of the
// coarser one.
double worst_factor(const Method& method, const KnownMotion& motion) {
  double worst = 0, last = INFINITY;
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const Run r = run(method, *motion.system, motion.start, motion.end.t, {.rtol = rtol});
    BOOST_REQUIRE(r.summary.message == "");
    const double error = distance(r.state, motion.end);
    worst = error < last ? std::max(worst, error / rtol) : INFINITY;
    const Counts& c = r.summary.counts;
    last = 2 * c.stability_limited_steps > c.steps ? INFINITY : error;
  }
  return worst;
}

}  // namespace

BOOST_AUTO_TEST_CASE(two_unlike_methods_agree_on_the_nonlinear_reference) {
  for (const int dimension : {2, 3}) {
    const KnownMotion motion("hammock", hammock(dimension));
    const State other = by_fehlberg(motion);
    // Half of the smallest errors that an order is drawn from.
    BOOST_TEST(distance(motion.end.q, other.q) < floor_q / 2);
    BOOST_TEST(distance(motion.end.v, other.v) < floor_v / 2);
  }
}

BOOST_DATA_TEST_CASE(every_method_of_fixed_steps_has_its_order, of_fixed_steps(), method) {
  for (const KnownMotion* motion : motions_of(method)) {
    // Higher terms that are large, or cancel the leading one, take more halvings to vanish.
    int halvings = method.order == 1 ? most_halvings : usual_halvings;
    Orders observed = observed_orders(method, *motion, halvings);
    while (!is_of_order(method, observed) && !method.recurrence_roots &&
           ++halvings <= most_halvings)
      observed = observed_orders(method, *motion, halvings);
    BOOST_TEST_CONTEXT(motion->name << ", in q " << observed.q << ", in v " << observed.v) {
      BOOST_TEST(is_of_order(method, observed));
    }
  }
}

BOOST_DATA_TEST_CASE(steps_that_a_method_chooses_show_its_order, of_chosen_steps(), method) {
  // ARKODE keeps a step size until it can be longer by half. The highest orders take some ten steps
  // in a second, too few to show the order. At 1e-4 rodas4 takes fifty, and the first ones,
  // which grow by factors, count.
  const bool is_own = method.family == Family::hand_written;
  const bool is_nystrom = is_own && !method.is(Trait::implicit);
  const bool is_long = method.order > 5 && !is_own;
  const double rtol = is_own              ? (method.order == 8            ? 1e-6
                                             : method.is(Trait::implicit) ? 1e-5
                                                                          : 1e-4)
                      : method.order == 2 ? 1e-4
                      : is_long           ? 1e-8
                                          : 1e-7;
  std::vector<Problem> problems = {problem_for(method, is_own ? 3 : 2)};
  if (is_own) problems.push_back(linear_hammock(2));
  for (const Problem& p : problems) {
    const double order = order_by_tolerance(method, {"hammock", p, is_long ? 6. : 1.}, rtol);
    // Up to 0.06 is seen, and more where errors cancel by chance.
    BOOST_TEST(std::abs(order - method.order) < (is_nystrom ? 0.7 : 0.2), order);
  }
}

BOOST_DATA_TEST_CASE(motions_are_as_exact_as_the_tolerance_asks, adaptive(), method) {
  for (const KnownMotion* motion : motions_of(method)) {
    BOOST_TEST(worst_factor(method, *motion) < largest_factor(method), motion->name);
  }
}

BOOST_AUTO_TEST_SUITE_END()
