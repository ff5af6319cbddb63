// The bounds that a search knows of its runs; its results are tested in test_solve.cpp.
#include <algorithm>
#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "tests/measure/clocks.hpp"
#include "tests/measure/drawn_scenes.hpp"

using namespace qddot;

BOOST_FIXTURE_TEST_SUITE(search, ProcessorClock)

namespace {

// Long enough for whatever is begun.
constexpr double seconds = 100;

double error_of(const Trial& trial, const Search& search, const Reference& reference) {
  return errors_between(search.stage().model(), trial.path.back(), reference.end, reference.energy,
                        search.stage().scales())
      .position;
}

// The result of a search on a drawn case, and its true accuracy.
struct Finding {
  explicit Finding(std::uint64_t seed) : drawn(judged_advice::drawn_case(seed)) {
    BOOST_TEST_REQUIRE(search.survey(drawn.accuracy));
    found = search.find(drawn.accuracy);
    BOOST_TEST_REQUIRE((found != nullptr));
    bound = search.bound(*found);
    BOOST_TEST_REQUIRE((bound && bound->by));
  }

  judged_advice::Case drawn;
  ReducedScene model{drawn.scene};
  Search search{model, drawn.until, AccuracyOf::positions, seconds};
  const Trial* found = nullptr;
  std::optional<Bound> bound{};
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_first_run_that_has_to_be_made_shorter_is_no_trouble) {
  // Here w_max grows so much that the first steps do not hold, and the run is looked at fewer times
  // than its length asks for.
  for (const std::uint64_t seed : {191u, 398u}) {
    const judged_advice::Case c = judged_advice::drawn_case(seed);
    const ReducedScene model(c.scene);
    Search search(model, c.until, AccuracyOf::positions, seconds);
    BOOST_TEST(search.survey(c.accuracy), c.scene.name);
    BOOST_TEST_REQUIRE(search.forecast().has_value());
    BOOST_TEST(
        std::ranges::count(search.trials(), std::string("verlet"),
                           [](const Trial& trial) { return std::string(trial.method->name); }) > 1,
        c.scene.name);
    const double w = search.forecast()->w_motion();
    BOOST_TEST(std::isfinite(w));
    BOOST_TEST(w >= search.w_start());
    const Answer answer = measure::solve(model, c.until, {.accuracy = c.accuracy, .seconds = 1});
    BOOST_TEST((answer.is_reached || !answer.why.empty()), c.scene.name);
  }
}

BOOST_AUTO_TEST_CASE(steps_that_meet_a_resonance_are_made_somewhat_shorter) {
  // 130 steps resolve the soft springs of this framed cloth, and grow all the same; 195 do not.
  const judged_advice::Case c = judged_advice::drawn_case(8000385);
  const ReducedScene model(c.scene);
  const CountedClock clock;
  Search search(model, c.until, AccuracyOf::positions, seconds);
  BOOST_TEST_REQUIRE(search.survey(c.accuracy));
  std::vector<Trial> tried;
  for (const Trial& trial : search.trials()) {
    if (trial.method == &method("multirate_adams4")) tried.push_back(trial);
  }
  BOOST_TEST_REQUIRE(tried.size() >= 2);
  BOOST_TEST((tried[0].summary.outcome == Outcome::diverged));
  BOOST_TEST((tried[1].summary.outcome != Outcome::diverged));
  BOOST_TEST(tried[1].value < tried[0].value);
  BOOST_TEST(tried[1].value > tried[0].value / 2);
}

BOOST_AUTO_TEST_CASE(the_finer_of_two_runs_is_within_their_distance) {
  const ReducedScene model(drawn("orbit", {}));
  const double until = 2, h = 0.01;
  const Reference reference = make_reference(model, until, seconds);
  for (const char* name : {"verlet", "symmetric6", "trapezoidal"}) {
    Search search(model, until, AccuracyOf::positions, seconds);
    const Method& tried = method(name);
    search.try_once({&tried, h}, seconds);
    BOOST_TEST(!search.bound(search.trials().front()));
    // Three times as accurate by the order, and somewhat more.
    search.try_once({&tried, h / std::pow(3.5, 1.0 / tried.order)}, seconds);
    const Trial &coarse = search.trials().front(), &fine = search.trials().back();
    search.measure_by(fine);
    BOOST_TEST((search.checker(coarse) == &fine));
    BOOST_TEST(!search.checker(fine));
    BOOST_TEST((search.coarser(fine) == &coarse));
    for (const Trial* trial : {&coarse, &fine}) {
      const auto bound = search.bound(*trial);
      BOOST_TEST_REQUIRE(bound.has_value());
      const double error = error_of(*trial, search, reference);
      BOOST_TEST(error <= bound->error, name);
      // The bound is not much larger: twice their distance, which is at least 0.7 of the coarse
      // error.
      BOOST_TEST(bound->error <= 8 * error, name);
      BOOST_TEST(bound->by_coarser == (trial == &fine), name);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_is_hardly_finer_bounds_the_other_where_its_order_is_known) {
  const ReducedScene model(drawn("orbit", {}));
  const double until = 2, h = 0.01;
  const Reference reference = make_reference(model, until, seconds);
  for (const char* name : {"verlet", "symmetric6", "trapezoidal"}) {
    const Method& tried = method(name);
    for (const double finer : {1.2, 1.6}) {
      Search search(model, until, AccuracyOf::positions, seconds);
      search.try_once({&tried, h}, seconds);
      search.try_once({&tried, h / std::pow(finer, 1.0 / tried.order)}, seconds);
      const Trial& coarse = search.trials().front();
      search.measure_by(search.trials().back());
      const auto bound = search.bound(coarse);
      // A run that is 1.2 times as accurate leaves too little of the error to be seen; implicit
      // steps may be far too long for their order.
      BOOST_TEST_CONTEXT(name << " " << finer << " times as accurate") {
        BOOST_TEST_REQUIRE(bound.has_value() == (finer == 1.6 && !tried.is(Trait::implicit)));
        if (!bound) continue;
        BOOST_TEST(error_of(coarse, search, reference) <= bound->error);
        BOOST_TEST(bound->error <=
                   6 * error_of(coarse, search, reference));  // 4, and what h^p is off
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_far_within_the_accuracy_is_checked_by_what_is_hardly_finer) {
  // Verlet's method at its limit is 10^4 times as accurate here as asked for.
  Finding on(8000395);
  BOOST_TEST(on.bound->error <= on.drawn.accuracy);
  BOOST_TEST((on.bound->by->method == on.found->method));
  // A check twice as accurate takes 1.5 times the steps.
  BOOST_TEST(on.found->value / on.bound->by->value < 1.4);
}

BOOST_AUTO_TEST_CASE(a_coarser_run_checks_where_errors_fall_as_the_order_says) {
  Finding on(8000280);
  BOOST_TEST(on.bound->by_coarser);
  BOOST_TEST((on.bound->by->method == on.found->method));
  BOOST_TEST(on.bound->by->value > on.found->value);
  // The order leaves a small part of how far they are apart.
  const double apart = on.search.distance(*on.found, *on.bound->by);
  BOOST_TEST(on.bound->error <= 0.4 * apart);
  BOOST_TEST(on.bound->error <= on.drawn.accuracy);
  on.search.try_once({&method("symmetric10"), on.found->value / 2}, seconds);
  const double error = on.search.distance(*on.found, on.search.trials().back());
  BOOST_TEST(error <= on.bound->error);
  BOOST_TEST(on.bound->error <= 4 * error);  // a margin of 1.6, and what h^p is off
}

BOOST_AUTO_TEST_CASE(an_order_is_believed_to_leave_a_tenth_at_least) {
  const ReducedScene model(drawn("lattice", {}));
  const double until = 0.05, h = 2e-5;
  Search search(model, until, AccuracyOf::positions, seconds);
  const Method& tried = method("symmetric8");
  search.try_once({&tried, h}, seconds);
  search.try_once({&tried, h / 1.6}, seconds);  // 43 times as accurate
  const Trial &coarse = search.trials().front(), &fine = search.trials().back();
  search.measure_by(fine);
  const double apart = search.distance(coarse, fine);
  BOOST_TEST_REQUIRE(apart < 1e-4);
  const auto bound = search.bound(fine);
  BOOST_TEST_REQUIRE((bound && bound->by == &coarse));
  BOOST_TEST(bound->error >= 0.1 * apart);
  BOOST_TEST(bound->error <= 0.2 * apart);  // a margin of 1.6, and 0.9 of it is the coarse error
}

// Before a forecast, a method has no expected error. Its distance to a bounded run bounds its error
// all the same, by |q - q*| <= |q - q_best| + |q_best - q*|.
BOOST_AUTO_TEST_CASE(a_run_is_bounded_by_the_most_accurate_one) {
  const ReducedScene model(drawn("orbit", {}));
  const double until = 2, h = 0.01;
  const Reference reference = make_reference(model, until, seconds);
  Search search(model, until, AccuracyOf::positions, seconds);
  const Method &other = method("blanes_moan4"), &verlet = method("verlet");
  search.try_once({&other, h}, seconds);
  search.try_once({&verlet, h}, seconds);
  BOOST_TEST(!search.bound(search.trials().front()));
  search.try_once({&other, h / 1.5}, seconds);
  const Trial &first = search.trials()[1], &best = search.trials().back();
  // Compared once, and again where the motion is measured anew.
  const double unscaled = search.distance(first, best);
  search.measure_by(best);
  BOOST_TEST(search.distance(first, best) != unscaled);
  BOOST_TEST(search.distance(best, first) == search.stage().distance(first, best));
  const auto bound = search.bound(first), least = search.bound(best);
  BOOST_TEST_REQUIRE((bound && least));
  BOOST_TEST((bound->by == &best));
  BOOST_TEST(!bound->by_coarser);
  const double error = error_of(first, search, reference);
  BOOST_TEST(error <= bound->error);
  // The bound contains the error bound of the best run, and nothing else.
  const double apart = search.distance(first, best);
  BOOST_TEST(std::abs(bound->error - apart - least->error) <= 1e-15 * bound->error);
}

// Errors go through zero: a run that is good by chance says nothing of others. A search that makes
// such runs and one that makes the same runs but these, in the same order, know the same of each.
BOOST_AUTO_TEST_CASE(runs_that_are_good_by_chance_judge_and_teach_nothing) {
  const ReducedScene model(drawn("pendulum", {}));
  const double until = 0.5, accuracy = 1e-6;
  const CountedClock clock;
  Search gambling(model, until, AccuracyOf::positions, seconds),
      sober(model, until, AccuracyOf::positions, seconds);
  for (Search* search : {&gambling, &sober}) {
    BOOST_TEST_REQUIRE(search->survey(accuracy));
    for (const char* name : {"symmetric6", "verlet", "blanes_moan6"}) {
      for (const double steps : {1500, 6000})
        search->try_once({&method(name), until / steps}, seconds);
    }
  }
  // It takes longest, so that runs that are too coarse for this accuracy may be faster.
  const Trial& slow = *std::ranges::max_element(gambling.trials(), {}, &Trial::seconds);
  gambling.gamble(&slow, accuracy, seconds);
  BOOST_TEST_REQUIRE(std::ranges::any_of(gambling.trials(), &Trial::is_gamble));
  // A further run, from which both learn.
  for (Search* search : {&gambling, &sober})
    search->try_once({&method("verlet"), until / 1000}, seconds);
  constexpr double rounding = 1e-9;  // relative; nothing but the order of sums may differ
  int compared = 0;
  for (const Trial& trial : gambling.trials()) {
    const Method& of = *trial.method;
    if (trial.is_gamble || of.is(Trait::implicit) || of.knob != Knob::step_size) continue;
    BOOST_TEST_CONTEXT(of.name << " at " << trial.value) {
      const auto same = std::ranges::find_if(sober.trials(), [&](const Trial& other) {
        return other.method == &of && other.value == trial.value;
      });
      BOOST_TEST_REQUIRE((same != sober.trials().end()));
      const auto bound = gambling.bound(trial), known = sober.bound(*same);
      BOOST_TEST_REQUIRE(bound.has_value() == known.has_value());
      if (bound) BOOST_TEST(std::abs(bound->error / known->error - 1) < rounding);
      const double expected = gambling.forecast()->error(of, trial.value);
      BOOST_TEST(std::abs(expected / sober.forecast()->error(of, trial.value) - 1) < rounding);
      ++compared;
    }
  }
  BOOST_TEST(compared > 4);
}

// Not the answer alone: by whatever a run is bounded, its true error is within that. One in fifty
// may miss, as an answer may, and then not by much.
BOOST_AUTO_TEST_CASE(every_run_of_a_search_is_within_its_bound) {
  int bounded = 0, beyond = 0, bounded_by_one_it_does_not_check = 0;
  // The number of worthwhile runs depends on the machine's speed: cases continue until there are
  // enough.
  for (std::uint64_t seed = 5000000; bounded < 120; ++seed) {
    const judged_advice::Case c = judged_advice::drawn_case(seed);
    const ReducedScene model(c.scene);
    const auto reference = judge(c, model, 40, 0.5);
    if (!reference) continue;
    Search search(model, c.until, AccuracyOf::positions, seconds);
    const Trial* found = search.survey(c.accuracy) ? search.find(c.accuracy) : nullptr;
    if (found) search.race(found, c.accuracy, seconds);
    for (const Trial& trial : search.trials()) {
      const auto bound = search.bound(trial);
      // Runs with an error as large as the motion are lost, and so are their bounds.
      if (!bound || bound->error > 0.1) continue;
      ++bounded;
      bounded_by_one_it_does_not_check += bound->by && bound->by != search.checker(trial);
      const double error = error_of(trial, search, *reference) - reference->certified.position;
      beyond += error > bound->error;
      BOOST_TEST(error <= 2 * bound->error, c.scene.name << " by " << trial.method->name);
    }
  }
  BOOST_TEST(bounded_by_one_it_does_not_check > 0);
  BOOST_TEST(beyond <= 0.02 * bounded);
}

// Implicit steps may be nothing like what is expected of them. They judge other methods once an
// error of theirs was seen.
BOOST_AUTO_TEST_CASE(what_is_expected_of_implicit_steps_judges_no_other_method) {
  const ReducedScene model(drawn("orbit", {}));
  const double until = 2;
  Search search(model, until, AccuracyOf::positions, seconds);
  // No few implicit steps come there, so that there is a forecast.
  BOOST_TEST_REQUIRE(search.survey(1e-12));
  BOOST_TEST_REQUIRE(search.forecast().has_value());
  const Trial& first = search.trials().back();
  BOOST_TEST_REQUIRE((first.method == &method("verlet")));
  const Method& vague = method("linear_midpoint4");
  search.try_once({&vague, until / 2000}, seconds);
  const Trial& implicit = search.trials().back();
  BOOST_TEST_REQUIRE(search.error(implicit) < 0.01 * search.error(first));
  BOOST_TEST(!search.checker(first));
  BOOST_TEST((search.most_accurate() == &first));
  // Coarse steps are seen to miss by so much.
  search.try_once({&vague, until / 1000}, seconds);
  BOOST_TEST_REQUIRE(search.forecast()->has_learned(vague));
  BOOST_TEST((search.checker(first) == &implicit));
  BOOST_TEST((search.most_accurate() == &implicit));
}

BOOST_AUTO_TEST_CASE(an_implicit_method_that_diverges_gets_more_steps) {
  // A run that diverges does not tell by how much it misses. The next one has six times as many
  // steps, which is the most that one more run has.
  constexpr double most = 6, unlimited = std::numeric_limits<double>::infinity();
  const judged_advice::Case c = judged_advice::drawn_case(4000205);
  const ReducedScene model(c.scene);
  Search search(model, c.until, AccuracyOf::positions, seconds);
  // No few implicit steps come there, so that there is a forecast.
  BOOST_TEST_REQUIRE(search.survey(1e-12));
  BOOST_TEST_REQUIRE(search.forecast().has_value());
  const Method& midpoint = method("linear_midpoint");
  // The survey may have made some of these runs, and finer ones on a fast machine.
  const auto has_diverged = [&](const Trial& trial) {
    return trial.method == &midpoint && trial.summary.outcome == Outcome::diverged;
  };
  for (int steps = 1; steps < 100 && std::ranges::none_of(search.trials(), has_diverged); ++steps)
    search.try_once({&midpoint, c.until / steps}, seconds);
  BOOST_TEST_REQUIRE(std::ranges::any_of(search.trials(), has_diverged));
  double shortest = unlimited;
  for (const Trial& trial : search.trials()) {
    if (trial.method == &midpoint) shortest = std::min(shortest, trial.value);
  }
  const auto next = search.more_steps(midpoint, c.accuracy, unlimited);
  BOOST_TEST_REQUIRE(next.has_value());
  BOOST_TEST(std::abs(most * next->value / shortest - 1) < 1e-9);  // rounding
  // No run that takes longer than a search has time for.
  BOOST_TEST(!search.more_steps(midpoint, c.accuracy, 0).has_value());
}

BOOST_AUTO_TEST_SUITE_END()
