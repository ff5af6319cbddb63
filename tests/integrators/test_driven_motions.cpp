// Every method with supports that move and loads that change: its order in positions, velocities
// and the work that driving does, or its refusal; the balance of energy; corners.
#include <boost/numeric/odeint.hpp>
#include <boost/test/unit_test.hpp>

#include "qddot/model/capabilities.hpp"
#include "tests/integrators/motions.hpp"
#include "tests/integrators/work_orders.hpp"
#include "tests/model/driven.hpp"

BOOST_AUTO_TEST_SUITE(driven_motions)

using namespace qddot;

namespace {

Problem driven_problem(Problem p, bool has_dashpots, bool has_air) {
  int number = 0;
  for_springs(p.network, [&](auto& spring) {
    if (has_dashpots && number++ % 4 != 3) spring.law.damping = 0.4;
  });
  if (has_air) p.network.air_damping = 0.6;
  p.network = driven(p.network);
  return p;
}

struct DrivenMotion {
  std::string name;
  std::shared_ptr<const System> system;
  State start, end;  // with the work
};

// By an explicit Runge-Kutta pair on (q, v, W_damped, W_driven), which shares nothing with the
// methods under test.
State by_fehlberg(const System& system, const State& start, double until) {
  using Y = std::vector<double>;
  namespace odeint = boost::numeric::odeint;
  const Index n = system.size();
  Y y(start.q.begin(), start.q.end());
  y.insert(y.end(), start.v.begin(), start.v.end());
  y.resize(y.size() + 2);
  const auto rate = [&](const Y& at, Y& change, double t) {
    const Vec q = Eigen::Map<const Vec>(at.data(), n), v = Eigen::Map<const Vec>(at.data() + n, n);
    Vec f(n), friction = Vec::Zero(n);
    system.force({t, q, v}, f);
    if (const Damping* damping = system.damping()) damping->friction({t, q, v}, friction);
    const Work work = offered(system.driving()).driving_power({t, q, v});
    change.assign(v.begin(), v.end());
    for (Index i = 0; i < n; ++i) change.push_back(f[i] / system.mass()[i]);
    change.push_back(work.dissipated - friction.dot(v));
    change.push_back(work.driven);
  };
  const auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<Y>>(1e-15, 1e-15);
  odeint::integrate_adaptive(stepper, rate, y, start.t, until, 1e-3);
  const auto rest = y.end() - 2;
  return {
      until, Eigen::Map<Vec>(y.data(), n), Eigen::Map<Vec>(y.data() + n, n), {rest[0], rest[1]}};
}

DrivenMotion driven_motion(std::string name, const Problem& p) {
  const std::shared_ptr<const System> system = make_mass_spring(p.network);
  return {std::move(name), system, p.initial, by_fehlberg(*system, p.initial, 1)};
}

std::vector<DrivenMotion> motions_for(const Method& method) {
  static const DrivenMotion
      plain = driven_motion("hammock", driven_problem(hammock(3), false, false)),
      air = driven_motion("hammock in air", driven_problem(hammock(3), false, true)),
      any = driven_motion("damped hammock", driven_problem(hammock(3), true, true)),
      linear = driven_motion("linear hammock", driven_problem(linear_hammock(2), false, false)),
      linear_air =
          driven_motion("linear hammock in air", driven_problem(linear_hammock(2), false, true));
  if (method.asks(Need::constant_stiffness)) return {linear, linear_air};
  switch (method.takes_damping()) {
    case Damped::none:
      return {plain, linear};
    case Damped::by_air:
      return {plain, air};
    default:
      return {plain, any};
  }
}

bool is_driven(const Method& m) { return !m.asks(Need::autonomous) && !m.asks(Need::split_forces); }
std::vector<Method> of_fixed_steps() {
  return methods_where(
      [](const Method& m) { return is_driven(m) && m.knob == Knob::step_size && m.order > 0; });
}
std::vector<Method> of_chosen_steps() {
  return methods_where([](const Method& m) { return is_driven(m) && m.knob == Knob::rtol; });
}
std::vector<Method> of_split_forces() {
  return methods_where(
      [](const Method& m) { return !m.asks(Need::autonomous) && m.asks(Need::split_forces); });
}
std::vector<Method> refusing() {
  return methods_where([](const Method& m) { return m.asks(Need::autonomous); });
}

double balance(const System& system, const State& start, const State& end) {
  return total_energy(system, end) + end.work.taken() - total_energy(system, start);
}

}  // namespace

BOOST_DATA_TEST_CASE(every_method_keeps_its_order, of_fixed_steps(), method) {
  // Higher terms of the long formulas lead until errors are near rounding.
  const bool is_long = method.symmetric_formula && method.order >= 8;
  const double slack = is_long ? 1 : method.order > 4 ? 0.4 : 0.15;
  const double more = is_long ? 4 : method.name == "rk8" ? 1.2 : slack + 0.1;
  double least_driven = INFINITY;
  for (const DrivenMotion& motion : motions_for(method)) {
    const Orders observed =
        observed_orders(method, *motion.system, motion.start, motion.end, &Work::driven);
    least_driven = std::min(least_driven, observed.work);
    BOOST_TEST_CONTEXT(motion.name << ", in q " << observed.q << ", in v " << observed.v
                                   << ", in the work of driving " << observed.work) {
      BOOST_TEST(std::min(observed.q, observed.v) > method.order - slack);
      BOOST_TEST(std::max(observed.q, observed.v) < method.order + more);
      // Errors of one number may cancel, which makes them fall faster, and slower afterwards.
      BOOST_TEST(observed.work > method.order - 2.7 * slack);
    }
  }
  // So no more than one of two motions is without an error of the method's own order.
  BOOST_TEST(least_driven < method.order + more + slack);
}

BOOST_DATA_TEST_CASE(methods_that_choose_steps_are_within_their_tolerance, of_chosen_steps(),
                     method) {
  for (const DrivenMotion& motion : motions_for(method))
    check_tolerances(method, *motion.system, motion.start, motion.end);
}

BOOST_DATA_TEST_CASE(methods_of_stiff_and_soft_springs_book_the_work_once, of_split_forces(),
                     method) {
  Problem p = driven_problem(hammock(3), false, false);
  p.network = with_split(p.network);
  const auto system = make_mass_spring(p.network);
  const State end = by_fehlberg(*system, p.initial, 1);
  const bool is_fixed = method.knob == Knob::step_size;
  const Run r = run(method, *system, p.initial, 1, options_of(method, 1e-3, 1e-8));
  BOOST_TEST_REQUIRE(r.summary.message == "");
  // h^2 of some hundred, or tolerances as above.
  const double most = is_fixed ? 1e-3 : 1e-5;
  BOOST_TEST(distance(r.state, end) < most);
  BOOST_TEST(std::abs(r.state.work.driven - end.work.driven) < 10 * most);
}

BOOST_DATA_TEST_CASE(a_method_for_constant_forces_says_so, refusing(), method) {
  Problem p = problem_for(method);
  p.network = driven(p.network);
  const State before = p.initial;
  const Run r = run(method, p, 1, options_of(method, 1e-2, 1e-3));
  BOOST_TEST((r.summary.outcome == Outcome::not_autonomous));
  BOOST_TEST(r.summary.message == advice(Outcome::not_autonomous));
  BOOST_TEST(same(r.state, before));
}

// The work is that of the energy, whatever the step.
BOOST_AUTO_TEST_CASE(discrete_gradient_keeps_the_balance_at_any_step) {
  for (const bool has_dashpots : {false, true}) {
    const Problem p = driven_problem(hammock(3), has_dashpots, false);
    const auto system = make_mass_spring(p.network);
    for (const double h : {0.1, 0.03, 0.01}) {
      const Run r = run(method_named("discrete_gradient"), *system, p.initial, 1,
                        {.step_size = h, .solve_tolerance = 1e-14});
      BOOST_TEST_REQUIRE(r.summary.message == "");
      const double size = total_energy(*system, p.initial) + std::abs(r.state.work.driven);
      BOOST_TEST(std::abs(balance(*system, p.initial, r.state)) < 1e-12 * size);
      BOOST_TEST(std::abs(r.state.work.driven) > 0.1);
    }
  }
}

// A million steps: kicks keep E less their work in bounds, which shrink with the square of h. The
// support moves by the golden ratio of the spring's frequency, so that no resonance grows.
BOOST_AUTO_TEST_CASE(the_balance_of_verlet_stays_bounded_over_a_million_steps) {
  Oscillator oscillator;
  Problem p = oscillator.problem();
  p.network.curves = {{.harmonics = {{{0.3, 0, 0}, oscillator.omega() * 0.618, 0}}}};
  p.network.anchors[0].curve = 0;
  const auto system = make_mass_spring(p.network);
  const double h = 0.2 / oscillator.omega(), until = 1e6 * h;
  double first = 0, last = 0, most_driven = 0;
  Film film{.times = {}};
  for (int i = 1; i <= 4000; ++i) film.times.push_back(until * i / 4000.7);
  const Run r =
      run(method_named("verlet"), *system, p.initial, until, {.step_size = h}, film.observer());
  BOOST_TEST_REQUIRE(r.summary.message == "");
  BOOST_TEST(r.summary.energy_growth < 1.02);
  for (std::size_t i = 0; i < film.seen.size(); ++i) {
    double& worst = i < film.seen.size() / 2 ? first : last;
    worst = std::max(worst, std::abs(balance(*system, p.initial, film.seen[i])));
    most_driven = std::max(most_driven, std::abs(film.seen[i].work.driven));
  }
  // (h w)^2/8 of the energies, which are several times that of the start; and no growth.
  BOOST_TEST(first < 0.02 * (oscillator.energy() + most_driven));
  BOOST_TEST(last < 1.05 * first);
  BOOST_TEST(most_driven > 0.2 * oscillator.energy());
}

// Frozen at the start of each step, time turns any method into one of order 1.
BOOST_AUTO_TEST_CASE(a_support_that_stands_still_in_a_step_shows_in_the_order) {
  class Frozen final : public System {
   public:
    Frozen(const System& system, double h) : System(system.mass()), system_(system), h_(h) {}
    double potential(const At& at) const override { return system_.potential(at); }
    void force(const At& at, MutableVec f) const override {
      // A hundredth of a step before its end, time is that of its start.
      system_.force({h_ * std::floor(at.t / h_ - 0.01), at.q}, f);
    }
    bool is_autonomous() const override { return false; }

   private:
    const System& system_;
    double h_;
  };
  const DrivenMotion motion = motions_for(method_named("dprkn6")).front();
  for (const char* name : {"verlet", "rk4", "blanes_moan6"}) {
    const auto error = [&](double h) {
      const Run r =
          run(method_named(name), Frozen(*motion.system, h), motion.start, 1, {.step_size = h});
      return distance(r.state.q, motion.end.q);
    };
    BOOST_TEST(std::abs(std::log2(error(1. / 800) / error(1. / 1600)) - 1) < 0.2, name);
  }
}

// m x'' = -k (x - s) - c (x' - s'), s = a sin(W t): from the closed form of the undamped motion,
// also at resonance, and of the steady state with a dashpot.
BOOST_AUTO_TEST_CASE(exact_is_right_to_rounding_also_at_resonance) {
  Oscillator oscillator;
  const double w = oscillator.omega(), a = 0.3, until = 7;
  for (const double ratio : {0.3, 0.999999, 1.0, 1 + 1e-9, 2.7}) {
    const double W = ratio * w;
    Problem p = oscillator.problem();
    p.network.curves = {{.harmonics = {{{a, 0, 0}, W, 0}}}};
    p.network.anchors[0].curve = 0;
    const auto system = make_mass_spring(p.network);
    using Long = long double;
    // x = free + a w^2 (sin Wt - W/w sin wt)/(w^2 - W^2), which is (sin wt - wt cos wt) a/2 at W =
    // w. With W = w (1 + e), the difference of sines is 2 cos sin, so that nothing cancels.
    const Long wl = w, Wl = W, t = until, e = (Wl - wl);
    Long driven = 0;
    if (std::abs(ratio - 1) < 1e-5) {
      // The series in e, to third order.
      const Long s = sinl(wl * t), c = cosl(wl * t);
      // d/dW of sin(Wt) - (W/w) sin(wt) and of w^2 - W^2, expanded.
      const Long top1 = t * c - s / wl, top2 = -t * t * s / 2, top3 = -t * t * t * c / 6;
      driven = a * wl * wl * (top1 + top2 * e + top3 * e * e) / (-(2 * wl + e));
    } else {
      driven = a * wl * wl * (sinl(Wl * t) - Wl / wl * sinl(wl * t)) / ((wl - Wl) * (wl + Wl));
    }
    const Long exact = oscillator.x0 * cosl(wl * t) + oscillator.v0 / wl * sinl(wl * t) + driven;
    for (const int steps : {1, 7, 100}) {
      const Run r =
          run(method_named("exact"), *system, p.initial, until, {.step_size = until / steps});
      BOOST_TEST_REQUIRE(r.summary.message == "");
      // Phases of w t = 35 have lost that many roundings; so many steps have as many again.
      const double size = 1 + std::abs(static_cast<double>(driven));
      BOOST_TEST(std::abs(r.state.q[0] - static_cast<double>(exact)) <
                 (70 + steps) * machine_epsilon * size);
      BOOST_TEST(std::abs(balance(*system, p.initial, r.state)) <
                 1e-13 * (oscillator.energy() + std::abs(r.state.work.driven)));
    }
  }
}

// Several modes, driven by harmonics, polynomials and loads, in air and without.
BOOST_AUTO_TEST_CASE(exact_drives_all_modes_at_any_step) {
  for (const DrivenMotion& motion : motions_for(method_named("exact"))) {
    for (const double h : {1.0, 0.3, 0.01}) {
      const Run r = run(method_named("exact"), *motion.system, motion.start, 1, {.step_size = h});
      BOOST_TEST_REQUIRE(r.summary.message == "");
      // The pair's tolerance of 1e-15 a step, in some thousand steps.
      BOOST_TEST(distance(r.state, motion.end) < 1e-11, motion.name);
      BOOST_TEST(std::abs(r.state.work.driven - motion.end.work.driven) < 1e-10);
      BOOST_TEST(std::abs(r.state.work.dissipated - motion.end.work.dissipated) < 1e-10);
    }
  }
}

BOOST_AUTO_TEST_CASE(exact_comes_to_the_steady_state_of_a_damped_support) {
  Oscillator oscillator;
  const double w = oscillator.omega(), m = oscillator.mass, a = 0.3, W = 1.3 * w, zeta = 0.4;
  Problem p = oscillator.problem();
  for_springs(p.network, [&](auto& spring) { spring.law.damping = 2 * zeta * w * m; });
  p.network.curves = {{.harmonics = {{{a, 0, 0}, W, 0.2}}}};
  p.network.anchors[0].curve = 0;
  const auto system = make_mass_spring(p.network);
  // Forty time constants: what is left of the start is 4e-18.
  const double until = 40 / (zeta * w);
  const Run r = run(method_named("exact"), *system, p.initial, until, {.step_size = until / 3});
  BOOST_TEST_REQUIRE(r.summary.message == "");
  using namespace std::complex_literals;
  const auto pull = w * w + 2i * zeta * w * W;  // of the spring and the dashpot
  const auto z = a * pull / (pull - W * W) * std::exp(1i * (W * until + 0.2));
  BOOST_TEST(std::abs(r.state.q[0] - z.imag()) < 1e-13);  // W t is 130 radians
  BOOST_TEST(std::abs(r.state.v[0] - (1i * W * z).imag()) < 1e-12);
  // Dashpots take the work that supports give, but for the change of the energy.
  BOOST_TEST(std::abs(balance(*system, p.initial, r.state)) < 1e-10 * r.state.work.driven);
  BOOST_TEST(r.state.work.dissipated > oscillator.energy());
}

// Steps land on the corners of a table, so that each method keeps its order.
BOOST_AUTO_TEST_CASE(a_table_keeps_the_order_of_every_method) {
  const DrivenMotion smooth = motions_for(method_named("rk4")).front();
  Problem p = hammock(3);
  p.network = driven(p.network, true);
  const auto system = make_mass_spring(p.network);
  // The reference begins anew at each corner.
  State end = p.initial;
  for (const double t : {0.21, 0.37, 0.6, 0.83, 1.0}) {
    const Work before = end.work;
    end = by_fehlberg(*system, end, t);
    end.work += before;
  }
  // So many steps that errors are below 1e-3 and above rounding.
  const std::pair<const char*, double> chosen[] = {
      {"verlet", 900},     {"rk4", 200},      {"blanes_moan6", 40},
      {"symmetric8", 150}, {"kahan_li8", 30}, {"implicit_midpoint", 900}};
  for (const auto& [name, count] : chosen) {
    const Method& method = method_named(name);
    const auto error = [&](double steps) {
      const Run r = run(method, *system, p.initial, 1, {.step_size = 1 / steps});
      BOOST_TEST_REQUIRE(r.summary.message == "");
      return distance(r.state.q, end.q);
    };
    // Over a factor of two in steps that do not divide the intervals of the table.
    const double order = std::log2(error(count + 1.3) / error(2 * count + 0.7));
    BOOST_TEST(order > method.order - 0.6, name << " has order " << order);
  }
  for (const char* name : {"dprkn8", "dprkn12", "arkode_erk8", "ida", "rodas4"}) {
    const Run r = run(method_named(name), *system, p.initial, 1, {.rtol = 1e-9});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    BOOST_TEST(distance(r.state, end) < 1e-5, name);
  }
}

// Without a corner to land on, a bend of the load leaves second order. A support that pulls a
// dashpot has a jump of the force there, and a step that ends on it belongs to the piece before.
BOOST_AUTO_TEST_CASE(a_bend_is_landed_on_from_its_own_side) {
  Oscillator oscillator;
  Problem p = oscillator.problem();
  const double bend = 0.3717;
  p.network.curves = {
      {.tables = {PiecewiseCubic::straight({0, bend, 1}, {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}})}}};
  p.network.driven_loads = {{0, 0, 20, Eigen::Vector3d::Zero()}};
  Problem pulled = oscillator.problem();
  pulled.network.curves = p.network.curves;
  pulled.network.anchors[0].curve = 0;
  pulled.network.anchors[0].law.damping = 3;
  for (const Problem& problem : {p, pulled}) {
    const auto driven = make_mass_spring(problem.network);
    const Run end = run(method_named("exact"), *driven, p.initial, 1, {.step_size = 1});
    for (const char* name : {"rk4", "verlet", "trapezoidal", "symmetric4", "bdf2"}) {
      const Method& method = method_named(name);
      const auto error = [&](double steps) {
        return distance(run(method, *driven, p.initial, 1, {.step_size = 1 / steps}).state,
                        end.state);
      };
      const double order = std::log2(error(600) / error(1200));
      BOOST_TEST(order > method.order - 0.3, name << " has order " << order);
    }
  }
  const auto system = make_mass_spring(p.network);
  const Run truth = run(method_named("exact"), *system, p.initial, 1, {.step_size = 1});
  // Two halves of a run, each with its own corner or none, are the run.
  State half = p.initial;
  const auto integrator = make_integrator(method_named("exact"), *system, {.step_size = 1});
  integrator->advance(half, 0.2);
  integrator->advance(half, 1);
  BOOST_TEST(distance(half, truth.state) < 1e-13);
}

BOOST_AUTO_TEST_SUITE_END()
