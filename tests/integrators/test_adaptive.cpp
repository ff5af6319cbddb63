#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/analysis/linear_motion.hpp"
#include "qddot/integrators/base/nystrom.hpp"
#include "tests/integrators/nystrom_trees.hpp"
#include "tests/integrators/tables.hpp"

BOOST_AUTO_TEST_SUITE(adaptive)

using namespace qddot;

namespace {

const std::vector<WithTable<NystromPair>>& pairs() {
  static const auto list = methods_with_tables<Nystrom>();
  return list;
}

std::vector<Method> interpolating() {
  std::vector<Method> list = methods();
  std::erase_if(list, [](const Method& method) { return !method.is(Trait::interpolates); });
  return list;
}

// A motion and where it goes from any start, to rounding.
struct Case {
  std::unique_ptr<System> system;
  State initial;
  std::function<State(const State&, double)> from;
  State at(double t) const { return from(initial, t); }
};

Case linear() {
  const Problem p = linear_hammock(2);
  auto system = make_mass_spring(p.network);
  const auto motion = std::make_shared<LinearMotion>(*system);
  return {std::move(system), p.initial,
          [motion](const State& start, double t) { return motion->after(start, t); }};
}

Case nonlinear() {
  const Problem p = hammock(3);
  std::shared_ptr<System> system = make_mass_spring(p.network);
  return {make_mass_spring(p.network), p.initial, [system](const State& start, double t) {
            const double h = t / std::ceil(256 * t);
            return run(method_named("kahan_li8"), *system, start, t, {.step_size = h}).state;
          }};
}

// A step of the higher order of a pair, from its definition.
State formula(const NystromPair& pair, const System& system, const State& start, double h) {
  State end{start.t + h, start.q + h * start.v, start.v};
  std::vector<Vec> k;
  for (std::size_t i = 0; i < pair.c.size(); ++i) {
    Vec stage = start.q + pair.c[i] * h * start.v;
    for (std::size_t j = 0; j < i; ++j) stage += h * h * pair.a[i][j] * k[j];
    k.push_back(force_at(system, stage).cwiseQuotient(system.mass()));
    end.q += h * h * pair.b[i] * k[i];
    end.v += h * pair.b_prime[i] * k[i];
  }
  return end;
}

// An observer's times and what it saw at them.
struct Film {
  std::vector<double> times;
  std::vector<State> seen;
  Observer observer() {
    return {times, [this](const State& state) { seen.push_back(state); }};
  }
};

Film film(int frames, double t_end) {
  Film result;
  for (int i = 1; i < frames; ++i) result.times.push_back(i * t_end / frames);
  return result;
}

// A mass that runs into a wall that stiffens with depth: q'' = -50 q^3 at 10 m/s from far away. Its
// rates at first are a fraction of the fastest ones.
Problem wall() {
  Problem p{{.dimension = 1, .node_mass = Vec::Ones(1)}, {0, Vec{{-0.05}}, Vec{{10}}}};
  p.network.anchors = {{0, {0, 0, 0}, {.stiffness = 1e-3, .quartic = 5000}}};
  return p;
}

double largest_error(const std::vector<State>& states, const Case& c) {
  double worst = 0;
  for (const State& state : states) worst = std::max(worst, distance(state, c.at(state.t)));
  return worst;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_the_formula_of_its_pair) {
  for (const Case& c : {linear(), nonlinear()}) {
    for (const auto& [name, pair] : pairs()) {
      const double h = 0.01;
      const Run r = run(method_named(name), *c.system, c.initial, h, {.rtol = 1});
      BOOST_REQUIRE(r.summary.counts.steps == 1);
      // Rounding of numbers of 5 by 1e-16 in a few dozen operations.
      BOOST_TEST(distance(r.state, formula(pair, *c.system, c.initial, h)) < 1e-13);
      BOOST_TEST(distance(r.state, formula(pair, *c.system, c.initial, 1.001 * h)) > 1e-6);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_step_of_a_pair_errs_by_its_order_and_one) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.5);
  for (const Case& c : {linear(), nonlinear()}) {
    for (const auto& [name, pair] : pairs()) {
      // There are 20 starts, as errors of single ones vanish by chance at some h. h w goes from 1
      // to 4 down to a value above the influence of rounding.
      constexpr int count = 5;
      Vec logs(count), q = Vec::Zero(count), v = q;
      for (int start = 0; start < 20; ++start) {
        State begin = c.initial;
        for (double& speed : begin.v) speed += normal(random);
        double h = pair.order == 12 ? 0.16 : pair.order == 8 ? 0.08 : 0.04;
        for (int i = 0; i < count; ++i, h *= 0.85) {
          const State end = formula(pair, *c.system, begin, h), exact = c.from(begin, h);
          logs[i] = std::log(h);
          q[i] += (end.q - exact.q).squaredNorm();
          v[i] += (end.v - exact.v).squaredNorm();
        }
      }
      const double in_q = slope(logs, q.array().log() / 2), in_v = slope(logs, v.array().log() / 2);
      BOOST_TEST_CONTEXT(name << ": " << in_q << " in q, " << in_v << " in v") {
        BOOST_TEST(std::abs(in_v - (pair.order + 1)) < 0.5);
        // The order in q is the smaller one, and may be higher by one.
        BOOST_TEST(in_q > pair.order + 0.5);
        BOOST_TEST(in_q < pair.order + 2.5);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(errors_go_with_steps_to_the_minus_order) {
  for (const Case& c : {linear(), nonlinear()}) {
    for (const auto& [name, rtol] : {std::pair("dprkn6", 1e-4), std::pair("dprkn8", 1e-6)}) {
      const Method& method = method_named(name);
      const double order = order_by_tolerance(method, *c.system, c.initial, c.at(1), rtol);
      BOOST_TEST_CONTEXT(name << ": " << order) {
        BOOST_TEST(std::abs(order - method.order) < 0.7);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(forces_are_those_of_the_stages_and_nothing_else) {
  // Forces: one at the start, one of an Euler step for the first step size, s - 1 stages of each
  // attempt, and one at the end of a step unless that is the last stage.
  const auto system = make_mass_spring(wall().network);
  for (const auto& [name, pair] : pairs()) {
    std::int64_t rejected = 0;
    for (const double rtol : {1e-2, 1e-6, 1e-10}) {
      BOOST_TEST_CONTEXT(name << " at " << rtol) {
        const Run r = run(method_named(name), *system, wall().initial, 3, {.rtol = rtol});
        BOOST_TEST(r.summary.message == "");
        const Counts& k = r.summary.counts;
        const auto fresh = static_cast<std::int64_t>(pair.c.size()) - 1;
        const std::int64_t ends = pair.is_first_same_as_last() ? 0 : k.steps;
        Counts expected{.steps = k.steps, .rejected = k.rejected};
        expected.force_evaluations = 2 + fresh * (k.steps + k.rejected) + ends;
        expected.stiffness_evaluations = (k.steps + 49) / 50;
        expected.stability_limited_steps = k.stability_limited_steps;
        BOOST_TEST(k == expected);
        rejected += k.rejected;
      }
    }
    BOOST_TEST(rejected > 0);
  }
}

BOOST_AUTO_TEST_CASE(errors_are_of_the_size_of_the_tolerance_where_steps_are_rejected_too) {
  const Problem p = wall();
  const auto system = make_mass_spring(p.network);
  const double t_end = 0.4;  // almost twice there and back
  const State exact =
      run(method_named("kahan_li8"), *system, p.initial, t_end, {.step_size = 1e-4}).state;
  for (const Method& method : interpolating()) {
    for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9}) {
      const State end = run(method, *system, p.initial, t_end, {.rtol = rtol, .speed = 10}).state;
      BOOST_TEST_CONTEXT(method.name << " at " << rtol) {
        BOOST_TEST(distance(end.q, exact.q) < 2 * rtol);
        BOOST_TEST(distance(end.v, exact.v) < 20 * rtol);  // at 10 m/s
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(steps_are_held_to_the_stability_limit_at_coarse_tolerances) {
  const Case c = linear();
  for (const auto& [name, pair] : pairs()) {
    const auto counts = [&, &name = name](double rtol) {
      return run(method_named(name), *c.system, c.initial, 10, {.rtol = rtol}).summary.counts;
    };
    const Counts coarse = counts(10), fine = counts(1e-12);
    // All but where steps begin small, and the two that share what is left at the end.
    BOOST_TEST(2 * coarse.stability_limited_steps > coarse.steps);
    BOOST_TEST(fine.stability_limited_steps == 0);
    BOOST_TEST(coarse.rejected == 0);
  }
}

BOOST_AUTO_TEST_CASE(the_stability_limit_lets_vibrations_grow_by_a_hundredth_a_step) {
  const auto unit = make_mass_spring(Oscillator{.mass = 1, .stiffness = 1}.problem().network);
  const auto growth = [&](const NystromPair& pair, double hw) {
    Eigen::Matrix2d matrix;
    for (const int column : {0, 1}) {
      const Vec q = Vec::Constant(1, column == 0), v = Vec::Constant(1, column == 1);
      const State end = formula(pair, *unit, {0, q, v}, hw);
      matrix(0, column) = end.q[0];
      matrix(1, column) = end.v[0];
    }
    return spectral_radius(matrix);
  };
  for (const auto& [name, pair] : pairs()) {
    BOOST_TEST_CONTEXT(name) {
      double below = 0;
      for (int i = 1; i <= 1000; ++i) {
        below = std::max(below, growth(pair, pair.stable_hw * i / 1000));
      }
      BOOST_TEST(below < 1.01);
      BOOST_TEST(growth(pair, pair.stable_hw + 0.02) > 1.01);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_observer_changes_neither_the_end_nor_the_counts) {
  for (const Case& c : {linear(), nonlinear()}) {
    for (const Method& method : interpolating()) {
      for (const double rtol : {1e-2, 1e-5, 1e-9}) {
        Film watched = film(313, 2);
        watched.times.push_back(2);
        const Options options{.rtol = rtol};
        const Run a = run(method, *c.system, c.initial, 2, options, watched.observer());
        const Run b = run(method, *c.system, c.initial, 2, options);
        BOOST_TEST(b.summary.message == "");
        BOOST_TEST(same(a.state, b.state));
        BOOST_TEST(same(watched.seen.back(), b.state));
        // Order 12 takes 16 forces for each time between steps.
        Counts expected = b.summary.counts;
        if (method.name == "dprkn12") expected.force_evaluations += 16 * 312;
        BOOST_TEST(a.summary.counts == expected);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(between_steps_errors_are_of_the_size_of_those_at_their_ends) {
  for (const Case& c : {linear(), nonlinear()}) {
    for (const auto& [name, pair] : pairs()) {
      for (const double rtol : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
        const Options options{.rtol = rtol};
        const Method& method = method_named(name);
        Film watched = film(317, 2);
        run(method, *c.system, c.initial, 2, options, watched.observer());
        std::vector<State> ends;
        for (int i = 1; i <= 20; ++i) {
          ends.push_back(run(method, *c.system, c.initial, 0.1 * i, options).state);
        }
        const double between = largest_error(watched.seen, c), at_ends = largest_error(ends, c);
        BOOST_TEST_CONTEXT(name << " at " << rtol << ": " << between << ", " << at_ends) {
          // There are 20 ends and 316 times between; a rounding of q by 1e-15 is enlarged 1/h times
          // in v.
          BOOST_TEST(between < 5 * at_ends + 1e-11);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_force_that_is_no_number_from_some_place_on_ends_the_run_before_it) {
  const Oscillator o;
  const auto system = make_mass_spring(o.problem().network);
  for (const Method& method : interpolating()) {
    Relay relay(*system);
    relay.after_force = [](const ConstVec& q, MutableVec f) {
      if (q[0] < 0) f[0] = NAN;
    };
    BOOST_TEST_CONTEXT(method.name) {
      std::vector<double> shown;
      const Observer observer{{0.05, 0.1, 0.104, 0.2},
                              [&](const State& state) { shown.push_back(state.t); }};
      const Run alone = run(method, relay, o.problem().initial, 1, {.rtol = 1e-6});
      const Run watched = run(method, relay, o.problem().initial, 1, {.rtol = 1e-6}, observer);
      BOOST_TEST(name(alone.summary.outcome) == "not_finite");
      BOOST_TEST(is_finite(alone.state));
      BOOST_TEST(alone.state.q[0] >= 0);
      BOOST_TEST(alone.state.q[0] < 1e-9);  // as near as a step can be
      BOOST_TEST(same(alone.state, watched.state));
      BOOST_TEST(alone.summary.counts.steps == watched.summary.counts.steps);
      BOOST_TEST(alone.summary.counts.rejected == watched.summary.counts.rejected);
      for (const double t : {0.05, 0.1, 0.104, 0.2}) {
        BOOST_TEST((std::ranges::find(shown, t) != shown.end()) == (t <= alone.state.t));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_start_without_a_force_is_refused) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  for (const Method& method : interpolating()) {
    Relay relay(*system);
    relay.after_force = [](const ConstVec&, MutableVec f) { f[2] = INFINITY; };
    const Run r = run(method, relay, p.initial, 1, {.rtol = 1e-6});
    BOOST_TEST(name(r.summary.outcome) == "not_finite");
    BOOST_TEST(same(r.state, p.initial));
    BOOST_TEST(r.summary.counts.steps == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_motion_that_is_over_in_finite_time_ends_there) {
  // q'' = 6 q^2 from q = 1, v = 2 is q = 1/(1 - t)^2, which is infinite at t = 1.
  const auto system = make_mass_spring(Oscillator{.mass = 1}.problem().network);
  for (const Method& method : interpolating()) {
    Relay relay(*system);
    relay.after_force = [](const ConstVec& q, MutableVec f) { f[0] = 6 * q[0] * q[0]; };
    relay.after_stiffness = [](const Vec& q, SymmetricMatrix& k) { k.coeffRef(0, 0) = 12 * q[0]; };
    BOOST_TEST_CONTEXT(method.name) {
      const Run r = run(method, relay, {0, Vec{{1}}, Vec{{2}}}, 2, {.rtol = 1e-6});
      BOOST_TEST(name(r.summary.outcome) != "reached_end");
      BOOST_TEST(r.summary.message != "");
      BOOST_TEST(is_finite(r.state));
      // The tolerance of 1e-6, with which the end of the motion shifts.
      BOOST_TEST(std::abs(r.state.t - 1) < 1e-4);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_run_can_be_stopped_between_two_steps) {
  const Case c = nonlinear();
  for (const Method& method : interpolating()) {
    std::stop_source budget;
    Relay relay(*c.system);
    relay.after_force = [&, calls = 0](const ConstVec&, MutableVec) mutable {
      if (++calls == 200) budget.request_stop();
    };
    const Run r = run(method, relay, c.initial, 100, {.rtol = 1e-8}, {}, budget.get_token());
    BOOST_TEST(name(r.summary.outcome) == "over_budget");
    BOOST_TEST(r.state.t > 0);
    BOOST_TEST(distance(r.state, c.at(r.state.t)) < 1e-6);
    BOOST_TEST(r.summary.counts.force_evaluations < 220);
  }
}

BOOST_AUTO_TEST_CASE(tolerances_are_weighed_by_the_lengths_and_speeds_they_are_for) {
  // The same motion 1024 times as small takes the same steps with scales as small. So it does with
  // absolute tolerances equal to rtol times the scales.
  const Problem p = linear_hammock(2);
  Problem small = p;
  small.initial.q /= 1024;
  small.initial.v /= 1024;
  for (auto& anchor : small.network.anchors) anchor.point /= 1024;
  small.network.gravity /= 1024;
  const auto system = make_mass_spring(p.network), small_system = make_mass_spring(small.network);
  for (const Method& method : interpolating()) {
    const auto counts = [&](const System& which, const State& start, const Options& options) {
      return run(method, which, start, 1, options).summary.counts;
    };
    const Counts metres = counts(*system, p.initial, {.rtol = 1e-7, .length = 2, .speed = 2});
    BOOST_TEST(counts(*small_system, small.initial,
                      {.rtol = 1e-7, .length = 2. / 1024, .speed = 2. / 1024}) == metres);
    BOOST_TEST(counts(*system, p.initial, {.rtol = 1e-7, .atol = 2e-7}) == metres);
    BOOST_TEST(!(counts(*small_system, small.initial, {.rtol = 1e-7}) == metres));
  }
}

BOOST_AUTO_TEST_SUITE_END()
