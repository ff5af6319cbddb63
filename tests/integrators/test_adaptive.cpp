#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/nystrom.hpp"
#include "tests/integrators/motions.hpp"
#include "tests/integrators/nystrom_trees.hpp"
#include "tests/integrators/tables.hpp"

BOOST_AUTO_TEST_SUITE(adaptive)

using namespace qddot;

namespace {

const std::vector<WithTable<NystromPair>>& pairs() {
  static const auto list = methods_with_tables(&Method::nystrom_pair);
  return list;
}

// The methods of AdaptiveStep.
std::vector<Method> interpolating() {
  auto list = methods_with(Trait::interpolates);
  std::erase_if(list, [](const Method& method) { return method.family == Family::sundials; });
  return list;
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

Film film(int frames, double t_end) {
  Film result;
  for (int i = 1; i < frames; ++i) result.times.push_back(i * t_end / frames);
  return result;
}

// A mass that runs into a wall that stiffens with depth: q'' = -50 q^3 at 10 m/s from far away. Its
// rates at first are a fraction of the fastest ones.
Problem wall(double quartic = 5000) {
  Problem p{{.dimension = 1, .node_mass = Vec::Ones(1)}, {0, Vec{{-0.05}}, Vec{{10}}}};
  p.network.anchors = {{0, {0, 0, 0}, {.stiffness = 1e-3, .quartic = quartic}}};
  return p;
}

double largest_error(const std::vector<State>& states, const KnownMotion& c) {
  double worst = 0;
  for (const State& state : states)
    worst = std::max(worst, distance(state, c.after(c.start, state.t)));
  return worst;
}

// Each of up to 17 products and sums of up to 12 levels rounds by 1.1e-16 of what is added up. So
// do coefficients of 16 digits.
constexpr double rounding = 2e-15;

}  // namespace

BOOST_AUTO_TEST_CASE(there_are_as_many_terms_of_each_order_as_there_should_be) {
  std::vector<int> count(13, 0);
  const NystromTrees trees(pairs().front().table, 12);
  for (const NystromTree& tree : trees.all()) {
    ++count[static_cast<std::size_t>(tree.order)];
  }
  // Hairer, Norsett and Wanner, table II.14.2, and its recursion.
  const std::vector<int> expected = {0, 1, 1, 2, 3, 6, 10, 20, 36, 72, 137, 275, 541};
  BOOST_TEST(count == expected, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(each_pair_meets_all_conditions_of_its_orders_and_not_those_of_the_next) {
  for (const auto& [name, pair] : pairs()) {
    const NystromTrees trees(pair, pair.order + 1);
    for (int p = 1; p <= pair.order + 1; ++p) {
      const double higher = order_defect(trees.all(), pair.b, pair.b_prime, p);
      const double lower = order_defect(trees.all(), pair.lower_b, pair.lower_b_prime, p);
      BOOST_TEST_CONTEXT(name << " at order " << p << ": " << higher << ", " << lower) {
        BOOST_TEST((higher < rounding) == (p <= pair.order));
        BOOST_TEST((lower < rounding) == (p <= pair.lower_order));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_step_is_the_formula_of_its_pair) {
  for (const KnownMotion& c : {linear(), nonlinear()}) {
    for (const auto& [name, pair] : pairs()) {
      const double h = 0.01;
      const Run r = run(method_named(name), *c.system, c.start, h, {.rtol = 1});
      BOOST_REQUIRE(r.summary.counts.steps == 1);
      // Rounding of numbers of 5 by 1e-16 in a few dozen operations.
      BOOST_TEST(distance(r.state, formula(pair, *c.system, c.start, h)) < 1e-13);
      BOOST_TEST(distance(r.state, formula(pair, *c.system, c.start, 1.001 * h)) > 1e-6);
    }
  }
}

BOOST_AUTO_TEST_CASE(forces_are_those_of_the_stages_and_nothing_else) {
  // A run begins with one force, and with one more of an Euler step for the first step size. Each
  // attempt takes s - 1 stages. A step whose end is not its last stage takes one there.
  const Problem hard = wall(5e5);  // hard enough for rejections
  const auto system = make_mass_spring(hard.network);
  for (const auto& [name, pair] : pairs()) {
    std::int64_t rejected = 0;
    for (const double rtol : {1e-2, 1e-6, 1e-10}) {
      BOOST_TEST_CONTEXT(name << " at " << rtol) {
        const Run r = run(method_named(name), *system, hard.initial, 3, {.rtol = rtol});
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

BOOST_DATA_TEST_CASE(errors_are_of_the_size_of_the_tolerance_where_steps_are_rejected_too,
                     interpolating(), method) {
  const Problem p = wall();
  const double t_end = 0.4;  // almost twice there and back
  const State exact = run(method_named("kahan_li8"), p, t_end, {.step_size = 1e-4}).state;
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const State end = run(method, p, t_end, {.rtol = rtol, .speed = 10}).state;
    BOOST_TEST_CONTEXT(method.name << " at " << rtol) {
      BOOST_TEST(distance(end.q, exact.q) < 2 * rtol);
      BOOST_TEST(distance(end.v, exact.v) < 20 * rtol);  // at 10 m/s
    }
  }
}

BOOST_AUTO_TEST_CASE(steps_are_held_to_the_stability_limit_at_coarse_tolerances) {
  const KnownMotion c = linear();
  for (const auto& [name, pair] : pairs()) {
    const auto counts = [&, &by = name](double rtol) {
      return run(method_named(by), *c.system, c.start, 10, {.rtol = rtol}).summary.counts;
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
    double measured = 0;
    while (growth(pair, measured + 0.01) < 1.01) measured += 0.01;
    BOOST_TEST_CONTEXT("stable_hw of " << name << " is " << pair.stable_hw << "; measured "
                                       << measured) {
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
  for (const KnownMotion& c : {linear(), nonlinear()}) {
    for (const Method& method : interpolating()) {
      for (const double rtol : {1e-2, 1e-5, 1e-9}) {
        Film watched = film(313, 2);
        watched.times.push_back(2);
        const Options options{.rtol = rtol};
        const Run a = run(method, *c.system, c.start, 2, options, watched.observer());
        const Run b = run(method, *c.system, c.start, 2, options);
        BOOST_TEST(b.summary.message == "");
        BOOST_TEST(same(a.state, b.state));
        BOOST_TEST(same(watched.seen.back(), b.state));
        // Order 12 takes 16 forces for each time between steps.
        Counts expected = b.summary.counts;
        if (method.order == 12) expected.force_evaluations += 16 * 312;
        BOOST_TEST(a.summary.counts == expected);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(between_steps_errors_are_of_the_size_of_those_at_their_ends) {
  for (const KnownMotion& c : {linear(), nonlinear()}) {
    for (const auto& [name, pair] : pairs()) {
      for (const double rtol : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
        const Options options{.rtol = rtol};
        const Method& method = method_named(name);
        Film watched = film(317, 2);
        run(method, *c.system, c.start, 2, options, watched.observer());
        std::vector<State> ends;
        for (int i = 1; i <= 20; ++i) {
          ends.push_back(run(method, *c.system, c.start, 0.1 * i, options).state);
        }
        const double between = largest_error(watched.seen, c), at_ends = largest_error(ends, c);
        BOOST_TEST_CONTEXT(name << " at " << rtol << ": " << between << ", " << at_ends) {
          // There are 20 ends and 316 times between, which are trusted to half of a tolerance (in
          // the norm over all unknowns, of sizes up to 5); a rounding of q by 1e-15 is enlarged 1/h
          // times in v.
          BOOST_TEST(between < 5 * at_ends + rtol + 1e-11);
        }
      }
    }
  }
}

BOOST_DATA_TEST_CASE(a_force_that_is_no_number_from_some_place_on_ends_the_run_before_it,
                     interpolating(), method) {
  const Oscillator o;
  const auto system = make_mass_spring(o.problem().network);
  Relay relay(*system);
  relay.after_force = [](const ConstVec& q, MutableVec f) {
    if (q[0] < 0) f[0] = NAN;
  };
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

BOOST_DATA_TEST_CASE(a_motion_that_is_over_in_finite_time_ends_there, interpolating(), method) {
  // q'' = 6 q^2 from q = 1, v = 2 is q = 1/(1 - t)^2, which is infinite at t = 1.
  const auto system = make_mass_spring(Oscillator{.mass = 1}.problem().network);
  Relay relay(*system);
  relay.after_force = [](const ConstVec& q, MutableVec f) { f[0] = 6 * q[0] * q[0]; };
  relay.after_stiffness = [](const Vec& q, SymmetricMatrix& k) { k.coeffRef(0, 0) = 12 * q[0]; };
  const Run r = run(method, relay, {0, Vec{{1}}, Vec{{2}}}, 2, {.rtol = 1e-6});
  BOOST_TEST(name(r.summary.outcome) != "reached_end");
  BOOST_TEST(r.summary.message != "");
  BOOST_TEST(is_finite(r.state));
  // The tolerance of 1e-6, with which the end of the motion shifts.
  BOOST_TEST(std::abs(r.state.t - 1) < 1e-4);
}

BOOST_DATA_TEST_CASE(tolerances_are_weighed_by_the_lengths_and_speeds_they_are_for, interpolating(),
                     method) {
  // The same motion 1024 times as small takes the same steps with scales as small. So it does with
  // absolute tolerances equal to rtol times the scales.
  const Problem p = linear_hammock(2);
  Problem small = p;
  small.initial.q /= 1024;
  small.initial.v /= 1024;
  for (auto& anchor : small.network.anchors) anchor.point /= 1024;
  small.network.gravity /= 1024;
  const auto counts = [&](const Problem& which, const Options& options) {
    return run(method, which, 1, options).summary.counts;
  };
  const Counts metres = counts(p, {.rtol = 1e-7, .length = 2, .speed = 2});
  const Options scaled{.rtol = 1e-7, .length = 2. / 1024, .speed = 2. / 1024};
  BOOST_TEST(counts(small, scaled) == metres);
  BOOST_TEST(counts(p, {.rtol = 1e-7, .atol = 2e-7}) == metres);
  BOOST_TEST(!(counts(small, {.rtol = 1e-7}) == metres));
}

BOOST_DATA_TEST_CASE(steps_do_not_depend_on_the_units_of_time_and_length, interpolating(), method) {
  // The same motion with times and lengths in other units, powers of two: the same steps.
  const Problem p = linear_hammock(2);
  const auto scaled = [&](double time, double length) {
    Problem other = p;
    other.initial.q *= length;
    other.initial.v *= length / time;
    other.network.gravity *= length / (time * time);
    for (auto& anchor : other.network.anchors) anchor.point *= length;
    for_springs(other.network, [&](auto& spring) { spring.law.stiffness /= time * time; });
    return run(method, other, 2 * time,
               {.rtol = 1e-7, .length = 2 * length, .speed = 2 * length / time});
  };
  const Run here = scaled(1, 1);
  for (const auto& [time, length] :
       {std::pair{1024., 1.}, {1. / 1024, 1.}, {1e6, 1.}, {1e-6, 1e3}}) {
    BOOST_TEST_CONTEXT(method.name << " in units of " << time << " s and " << length << " m") {
      const Run there = scaled(time, length);
      BOOST_TEST(there.summary.counts.steps == here.summary.counts.steps);
      BOOST_TEST(there.summary.counts.rejected == here.summary.counts.rejected);
      // Steps that differ by rounding in units that are no powers of two: their errors of 1e-7
      // differ by as small a part, and numbers up to 5 round in some hundred steps.
      BOOST_TEST(distance(there.state.q / length, here.state.q) < 1e-11);
    }
  }
}

BOOST_DATA_TEST_CASE(a_start_that_says_little_is_left_in_any_unit_of_time, interpolating(),
                     method) {
  // At rest in a weak field: rates of 1e-11 in one unit, 1e-2 in the other.
  std::int64_t steps = 0;
  for (const double time : {1., 1. / (1 << 30)}) {
    const Problem p{
        {.dimension = 1, .gravity = {1e-11 / time / time, 0, 0}, .node_mass = Vec::Ones(1)},
        {0, Vec::Ones(1), Vec::Zero(1)}};
    const Run r = run(method, p, 1e4 * time, {.rtol = 1e-6, .speed = 1 / time});
    BOOST_TEST(r.summary.message == "");
    BOOST_TEST(std::abs(r.state.q[0] - 1.0005) < 1e-12);  // some roundings of 1 + 1/2 a t^2
    BOOST_TEST(r.summary.counts.steps < 20);
    if (steps > 0) BOOST_TEST(r.summary.counts.steps == steps);
    steps = r.summary.counts.steps;
  }
}

BOOST_DATA_TEST_CASE(an_observer_changes_no_end_where_states_are_separate_steps, interpolating(),
                     method) {
  // A mass passes its anchor on a line, where K changes along each step and no polynomial leads
  // over the jump.
  Problem p{{.dimension = 1, .node_mass = Vec::Ones(1)}, {0, Vec{{1.2}}, Vec{{-6}}}};
  p.network.anchors = {{0, {0, 0, 0}, {.stiffness = 20, .rest_length = 0.5, .quartic = 50}}};
  Film watched = film(97, 2);
  const Run a = run(method, p, 2, {.rtol = 1e-6}, watched.observer());
  const Run b = run(method, p, 2, {.rtol = 1e-6});
  BOOST_TEST(b.summary.message == "");
  BOOST_TEST(a.summary.counts.force_evaluations > b.summary.counts.force_evaluations);
  BOOST_TEST(same(a.state, b.state));
}

BOOST_AUTO_TEST_SUITE_END()
