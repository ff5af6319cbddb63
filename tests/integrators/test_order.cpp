#include <boost/numeric/odeint.hpp>
#include <boost/test/unit_test.hpp>

#include "qddot/analysis/linear_motion.hpp"
#include "tests/integrators/faulty_verlet.hpp"

BOOST_AUTO_TEST_SUITE(order)

using namespace qddot;

namespace {

// Errors of the end below these are rounding (some 1e-14 m and 1e-13 m/s), not truncation.
constexpr double floor_q = 1e-13, floor_v = 1e-12;

// A motion from t = 0, and where it ends after two to three periods of its fastest mode.
struct Case {
  std::unique_ptr<System> system;
  State initial, end;
};

Case oscillating() {
  const Oscillator o;
  const Problem p = o.problem();
  const double t = 2.4;
  return {make_mass_spring(p.network),
          p.initial,
          {t, Vec::Constant(1, o.position(t)), Vec::Constant(1, o.velocity(t))}};
}

Case linear(int dimension) {
  const Problem p = linear_hammock(dimension);
  auto system = make_mass_spring(p.network);
  State end = LinearMotion(*system).after(p.initial, 1);
  return {std::move(system), p.initial, std::move(end)};
}

// 512 steps of order 8: truncation is far below rounding (96 steps leave 2e-12 m/s).
Case nonlinear(int dimension) {
  const Problem p = hammock(dimension);
  auto system = make_mass_spring(p.network);
  State end = run(method_named("kahan_li8"), *system, p.initial, 1, {.step_size = 1. / 512}).state;
  return {std::move(system), p.initial, std::move(end)};
}

// The same motion by an explicit Runge-Kutta method of the first-order form, which shares nothing
// with the methods under test.
State by_fehlberg(const Case& c) {
  using Y = std::vector<double>;
  namespace odeint = boost::numeric::odeint;
  const Index n = c.system->size();
  Y y(c.initial.q.begin(), c.initial.q.end());
  y.insert(y.end(), c.initial.v.begin(), c.initial.v.end());
  const auto rate = [&](const Y& at, Y& change, double) {
    change.assign(at.begin() + n, at.end());
    const Vec f = force_at(*c.system, Eigen::Map<const Vec>(at.data(), n));
    for (Index i = 0; i < n; ++i) change.push_back(f[i] / c.system->mass()[i]);
  };
  const auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<Y>>(1e-15, 1e-15);
  odeint::integrate_adaptive(stepper, rate, y, 0.0, c.end.t, 1e-3);
  return {c.end.t, Eigen::Map<Vec>(y.data(), n), Eigen::Map<Vec>(y.data() + n, n)};
}

// The numbers of steps that are tried, one after the other. Order 1 needs the most steps, until its
// higher terms (h w / 2 of it) do not matter. Multistep methods need more steps than they begin
// with; their errors soon are so small that halvings would leave too few.
std::vector<int> step_counts(const Method& method) {
  const bool is_multistep = method.recurrence_roots != nullptr;
  std::vector<int> list;
  if (!is_multistep) {
    for (int steps = 6; steps <= 6 << 12; steps *= 2) list.push_back(steps);
  } else {
    for (double steps = 6 * method.order; steps < 6 << 12; steps *= 1.15) {
      list.push_back(static_cast<int>(steps));
    }
  }
  return list;
}

// The orders seen in q and v over the last five numbers of steps before rounding shows; over more
// where these are near each other.
Orders observed_orders(const Method& method, const Case& c) {
  std::vector<double> h, q, v;
  for (const int steps : step_counts(method)) {
    const Run r = run(method, *c.system, c.initial, c.end.t, {.step_size = c.end.t / steps});
    const double error_q = distance(r.state.q, c.end.q), error_v = distance(r.state.v, c.end.v);
    if (error_q < floor_q || error_v < floor_v) break;
    h.push_back(std::log(c.end.t / steps));
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

// Few halvings fit between higher terms and rounding at high orders.
bool is_of_order(int p, const Orders& observed) {
  const double slack = p > 4 ? 0.25 : 0.1;
  return std::abs(observed.q - p) <= slack && std::abs(observed.v - p) <= slack;
}
// A multistep method of order 8 or 10 is at rounding before its higher terms vanish, which make the
// slope steeper; its order conditions are tested exactly elsewhere.
bool is_of_order(const Method& method, const Orders& observed) {
  if (!method.recurrence_roots || method.order < 8) {
    return is_of_order(method.order, observed);
  }
  const double lower = std::min(observed.q, observed.v), upper = std::max(observed.q, observed.v);
  return lower >= method.order - 0.35 && upper <= method.order + 4;
}

void check_orders(const Case& c) {
  for (const Method& method : methods_of(Knob::step_size)) {
    const Orders observed = observed_orders(method, c);
    BOOST_TEST_CONTEXT(method.name << " in q " << observed.q << ", in v " << observed.v) {
      BOOST_TEST(is_of_order(method, observed));
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(two_unlike_methods_agree_on_the_nonlinear_reference) {
  for (const int dimension : {2, 3}) {
    const Case c = nonlinear(dimension);
    const State other = by_fehlberg(c);
    // Half of the smallest errors that an order is drawn from.
    BOOST_TEST(distance(c.end.q, other.q) < floor_q / 2);
    BOOST_TEST(distance(c.end.v, other.v) < floor_v / 2);
  }
}

BOOST_AUTO_TEST_CASE(every_fixed_step_method_has_its_order_on_the_oscillator) {
  check_orders(oscillating());
}

BOOST_AUTO_TEST_CASE(every_fixed_step_method_has_its_order_on_a_linear_network) {
  for (const int dimension : {1, 2, 3}) check_orders(linear(dimension));
}

BOOST_AUTO_TEST_CASE(every_fixed_step_method_has_its_order_on_a_nonlinear_network) {
  for (const int dimension : {2, 3}) check_orders(nonlinear(dimension));
}

BOOST_AUTO_TEST_CASE(a_coefficient_wrong_by_a_thousandth_is_noticed) {
  const Method right = faulty_verlet<0>();
  const Method wrong = faulty_verlet<1>();
  for (const Case& c : {linear(2), nonlinear(2)}) {
    BOOST_TEST(is_of_order(2, observed_orders(right, c)));
    BOOST_TEST(!is_of_order(2, observed_orders(wrong, c)));
  }
}

BOOST_AUTO_TEST_SUITE_END()
