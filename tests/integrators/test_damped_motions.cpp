// Every method with damping: its order in positions, velocities and the energy that damping takes,
// or its refusal; the balance of energy; momenta.
#include <boost/numeric/odeint.hpp>
#include <boost/test/unit_test.hpp>

#include "qddot/analysis/exponential_motion.hpp"
#include "tests/integrators/motions.hpp"
#include "tests/integrators/work_orders.hpp"

BOOST_AUTO_TEST_SUITE(damped_motions)

using namespace qddot;

namespace {

// Dashpots beside all springs but some, and air. Damping ratios are up to 0.4.
Problem damped(Problem p, bool has_dashpots) {
  int number = 0;
  for_springs(p.network, [&](auto& spring) {
    spring.law.damping = has_dashpots && number % 4 != 3 ? 0.4 + 0.3 * (number % 3) : 0;
    ++number;
  });
  p.network.air_damping = 0.6;
  return p;
}

struct DampedMotion {
  std::string name;
  std::shared_ptr<const System> system;
  State start, end;  // with the energy that damping has taken
};

// A motion that shares nothing with the methods under test: by an explicit Runge-Kutta pair on
// (q, v, W), W' = v'Cv.
State by_fehlberg(const System& system, const State& start, double until) {
  using Y = std::vector<double>;
  namespace odeint = boost::numeric::odeint;
  const Index n = system.size();
  Y y(start.q.begin(), start.q.end());
  y.insert(y.end(), start.v.begin(), start.v.end());
  y.push_back(0);
  SymmetricMatrix c = system.stiffness_pattern();
  const auto rate = [&](const Y& at, Y& change, double) {
    const Vec q = Eigen::Map<const Vec>(at.data(), n), v = Eigen::Map<const Vec>(at.data() + n, n);
    offered(system.damping()).damping_matrix(q, c);
    const Vec friction = c.selfadjointView<Eigen::Lower>() * v;
    const Vec f = force_at(system, q) - friction;
    change.assign(v.begin(), v.end());
    for (Index i = 0; i < n; ++i) change.push_back(f[i] / system.mass()[i]);
    change.push_back(friction.dot(v));
  };
  const auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<Y>>(1e-15, 1e-15);
  odeint::integrate_adaptive(stepper, rate, y, 0.0, until, 1e-3);
  return {until, Eigen::Map<Vec>(y.data(), n), Eigen::Map<Vec>(y.data() + n, n), y.back()};
}

DampedMotion damped_motion(std::string name, const Problem& p) {
  const std::shared_ptr<const System> system = make_mass_spring(p.network);
  return {std::move(name), system, p.initial, by_fehlberg(*system, p.initial, 1)};
}

const std::vector<DampedMotion>& motions_for(const Method& method) {
  static const std::vector<DampedMotion> any = {damped_motion("linear hammock",
                                                              damped(linear_hammock(2), true)),
                                                damped_motion("hammock", damped(hammock(3), true))},
                                         air = {damped_motion("linear hammock in air",
                                                              damped(linear_hammock(2), false)),
                                                damped_motion("hammock in air",
                                                              damped(hammock(3), false))},
                                         linear = {any[0], air[0]};
  if (method.asks(Need::constant_stiffness)) return linear;
  return method.takes_damping() == Damped::by_any ? any : air;
}

bool takes_damping(const Method& m) { return m.takes_damping() != Damped::none; }
std::vector<Method> of_fixed_steps() {
  return methods_where(
      [](const Method& m) { return takes_damping(m) && m.knob == Knob::step_size && m.order > 0; });
}
std::vector<Method> of_chosen_steps() {
  return methods_where([](const Method& m) { return takes_damping(m) && m.knob == Knob::rtol; });
}
std::vector<Method> all_methods() { return unconstrained_methods(); }
std::vector<Method> turning() {
  return methods_where([](const Method& m) {
    return is_general(m) && m.takes_damping() == Damped::by_any && keeps_angular_momentum(m);
  });
}

}  // namespace

BOOST_DATA_TEST_CASE(every_method_keeps_its_order, of_fixed_steps(), method) {
  // Few points fit between higher terms and rounding at high orders.
  const double slack = method.order > 4 ? 0.4 : 0.15;
  // The error of rk8 begins with a very small coefficient, so that the next order shows first.
  const double more = method.name == "rk8" ? 1.2 : slack + 0.1;
  double least_dissipated = INFINITY;
  for (const DampedMotion& motion : motions_for(method)) {
    const Orders observed =
        observed_orders(method, *motion.system, motion.start, motion.end, &Work::dissipated);
    least_dissipated = std::min(least_dissipated, observed.work);
    BOOST_TEST_CONTEXT(motion.name << ", in q " << observed.q << ", in v " << observed.v
                                   << ", in the energy taken " << observed.work) {
      BOOST_TEST(std::min(observed.q, observed.v) > method.order - slack);
      BOOST_TEST(std::max(observed.q, observed.v) < method.order + more);
      // Errors of one number may cancel, which makes them fall faster, and slower afterwards.
      BOOST_TEST(observed.work > method.order - 2.5 * slack);
    }
  }
  // So no more than one of two motions is without an error of the method's own order.
  BOOST_TEST(least_dissipated < method.order + more + slack);
}

// Each step is within the tolerance, and the energy that damping takes follows the motion.
BOOST_DATA_TEST_CASE(methods_that_choose_steps_are_within_their_tolerance, of_chosen_steps(),
                     method) {
  for (const DampedMotion& motion : motions_for(method))
    check_tolerances(method, *motion.system, motion.start, motion.end);
}

BOOST_DATA_TEST_CASE(a_method_that_takes_no_dashpots_says_why_and_what_to_take, all_methods(),
                     method) {
  const bool is_refusing = method.takes_damping() != Damped::by_any;
  BOOST_TEST((std::string(method.why_not_damped) != "") == is_refusing);
  if (!is_refusing) return;
  Problem p = damped(problem_for(method), true);
  const State before = p.initial;
  const Run r = run(method, p, 1, options_of(method, 1e-2, 1e-3));
  BOOST_TEST((r.summary.outcome == Outcome::refuses_damping));
  BOOST_TEST(r.summary.message.find(method.why_not_damped) != std::string::npos);
  BOOST_TEST(r.summary.message.find("take verlet") != std::string::npos);
  BOOST_TEST(same(r.state, before));
  for_springs(p.network, [](auto& spring) { spring.law.damping = 0; });
  const bool runs_in_air =
      run(method, p, 0.1, options_of(method, 1e-3, 1e-3)).summary.outcome == Outcome::reached_end;
  BOOST_TEST(runs_in_air == (method.takes_damping() == Damped::by_air));
}

// Without pins and air nothing takes momentum, and springs with rest lengths no angular momentum.
BOOST_DATA_TEST_CASE(dashpots_keep_momentum_and_angular_momentum, turning(), method) {
  Problem p = damped(hammock(3), true);
  p.network.air_damping = 0;
  p.network.anchors.clear();
  p.network.gravity.setZero();
  const auto system = make_mass_spring(p.network);
  const auto momenta = [&](const State& state) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (Index i = 0; i < state.q.size(); i += 3) {
      const Eigen::Vector3d x = state.q.segment<3>(i),
                            momentum = system->mass()[i] * state.v.segment<3>(i);
      sum.head<3>() += momentum;
      sum.tail<3>() += x.cross(momentum);
    }
    return sum;
  };
  Options options{.step_size = 0.01};
  if (method.listens_to(Option::solve_tolerance)) options.solve_tolerance = 1e-13;
  const Run r = run(method, *system, p.initial, 1, options);
  BOOST_TEST_REQUIRE(r.summary.message == "");
  const auto start = momenta(p.initial);
  // A hundred steps of a dozen roundings each, of momenta of some kg m/s.
  BOOST_TEST((momenta(r.state) - start).norm() < 1e-12 * (1 + start.norm()));
  BOOST_TEST(r.state.work.dissipated > 0.1);
}

BOOST_AUTO_TEST_CASE(discrete_gradient_keeps_the_balance_at_any_step) {
  const Problem p = damped(hammock(3), true);
  const auto system = make_mass_spring(p.network);
  for (const double h : {0.1, 0.03, 0.01, 0.001}) {
    const Run r = run(method_named("discrete_gradient"), *system, p.initial, 1,
                      {.step_size = h, .solve_tolerance = 1e-14});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    const double balance =
        total_energy(*system, r.state) + r.state.work.dissipated - total_energy(*system, p.initial);
    BOOST_TEST(std::abs(balance) < 1e-12 * total_energy(*system, p.initial), balance);
    BOOST_TEST(r.state.work.dissipated > 0.1);
  }
}

// A thousand periods: the error of the balance is that of the oscillation of the energy, h^2, and
// does not grow. Air and dashpots have taken most of the energy by then.
BOOST_AUTO_TEST_CASE(the_balance_of_verlet_is_bounded_and_falls_with_the_square_of_the_step) {
  Oscillator oscillator;
  Problem p = oscillator.problem();
  for_springs(p.network, [](auto& spring) { spring.law.damping = 1e-4 * spring.law.stiffness; });
  p.network.air_damping = 1e-4;
  const auto system = make_mass_spring(p.network);
  const double start = total_energy(*system, p.initial);
  double worst[2] = {0, 0};
  for (const int halving : {0, 1}) {
    Film film{.times = {}};
    for (int i = 1; i <= 997; ++i) film.times.push_back(1000 * oscillator.period() * i / 997.3);
    const double h = oscillator.period() / (halving == 0 ? 500 : 1000);
    const Run r = run(method_named("verlet"), *system, p.initial, 1000 * oscillator.period(),
                      {.step_size = h}, film.observer());
    BOOST_TEST_REQUIRE(r.summary.message == "");
    BOOST_TEST(r.summary.energy_growth < 1.001);
    for (const State& state : film.seen) {
      worst[halving] = std::max(
          worst[halving], std::abs(total_energy(*system, state) + state.work.dissipated - start));
    }
    BOOST_TEST(r.state.work.dissipated > 0.5 * start);
  }
  // (h w)^2/8 of the energy at 500 steps a period: 2e-5.
  BOOST_TEST(worst[0] < 1e-4 * start);
  BOOST_TEST(std::abs(worst[0] / worst[1] - 4) < 0.2);
}

// q'' = -w^2 q - 2 zeta w q', from its closed form.
BOOST_AUTO_TEST_CASE(exact_is_right_to_rounding_at_any_damping_ratio) {
  for (const double zeta : {0.0, 0.5, 1.0, 10.0, 1 - 1e-8, 1 + 1e-8}) {
    Oscillator oscillator;
    Problem p = oscillator.problem();
    const double w = oscillator.omega(), m = oscillator.mass, until = 1.3;
    for_springs(p.network, [&](auto& spring) { spring.law.damping = 2 * zeta * w * m; });
    using Long = long double;
    // Factors, of which no digits cancel.
    const std::complex<Long> root =
        std::sqrt(std::complex<Long>((Long(zeta) - 1) * (Long(zeta) + 1)));
    const std::complex<Long> a = Long(w) * (-Long(zeta) + root), b = Long(w) * (-Long(zeta) - root);
    const Long x0 = oscillator.x0, v0 = oscillator.v0;
    Long x, v;
    if (zeta == 1) {
      const Long e = std::exp(-Long(w) * until);
      x = e * (x0 + (v0 + w * x0) * until);
      v = e * (v0 - w * (v0 + w * x0) * until);
    } else {
      const std::complex<Long> first = (v0 - b * x0) / (a - b), second = (a * x0 - v0) / (a - b);
      x = (first * std::exp(a * Long(until)) + second * std::exp(b * Long(until))).real();
      v = (a * first * std::exp(a * Long(until)) + b * second * std::exp(b * Long(until))).real();
    }
    for (const int steps : {1, 7}) {
      const Run r = run(method_named("exact"), p, until, {.step_size = until / steps});
      BOOST_TEST_REQUIRE(r.summary.message == "");
      BOOST_TEST(std::abs(r.state.q[0] - static_cast<double>(x)) < 1e-14);
      BOOST_TEST(std::abs(r.state.v[0] - static_cast<double>(v)) < 1e-13);
    }
  }
}

// The exponential and the modes are two ways where C is in proportion to K.
BOOST_AUTO_TEST_CASE(exact_by_modes_and_by_the_exponential_agree) {
  Problem p = linear_hammock(3);
  for_springs(p.network, [](auto& spring) { spring.law.damping = 0.02 * spring.law.stiffness; });
  p.network.air_damping = 0.3;
  const auto system = make_mass_spring(p.network);
  const State by_modes = LinearMotion(*system).after(p.initial, 0.7);
  State by_exponential;
  ExponentialMotion(*system, 0.7).propagate(p.initial, by_exponential);
  BOOST_TEST(distance(by_modes, by_exponential) < 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()
