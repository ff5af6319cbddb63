#include "qddot/measure/advice/advise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/advice/trial.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::inline measure {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Time limits [s]. All runs together take at most `for_runs`, or `of_the_run` times the longest
// advised run. The perturbed run that detects chaos takes at most `for_twin`. SUNDIALS' methods are
// tried until `for_sundials` after the start.
constexpr double for_runs = 0.3, of_the_run = 1.8, for_twin = 0.15, for_sundials = 0.4;
// The fraction of an accuracy that a run is chosen to have as its expected error, as in solve().
constexpr double expected_to_miss = 0.45;

Candidate as_candidate(const Search& search, const Trial& trial) {
  const auto bound = search.bound(trial);
  return {trial.method, trial.value, bound ? bound->error : search.error(trial), trial.seconds};
}

void keep_faster(std::optional<Candidate>& fastest, const Candidate& candidate) {
  if (!fastest || candidate.seconds < fastest->seconds) fastest = candidate;
}

// A run, and whether it was made and checked.
struct Contender {
  Candidate run;
  bool is_seen = false;

  // Forecasts of implicit methods are poor before a run of theirs: neither error nor time is
  // reliable.
  bool is_vague() const { return !is_seen && run.method->is(Trait::implicit); }
  // The run's time [s]; a forecast time is raised, as it is uncertain.
  double handicapped() const {
    constexpr double unseen = 1.3;
    return is_seen ? run.seconds : unseen * run.seconds;
  }
};

// The runs that reach the accuracy, as forecast or as measured: one for each method, fastest first.
std::vector<Contender> contenders(const Search& search, double accuracy) {
  std::vector<Contender> all;
  if (search.forecast()) {
    for (const Candidate& c : search.forecast()->candidates(expected_to_miss * accuracy)) {
      if (c.error <= accuracy) all.push_back({c});
    }
  }
  for (const Trial& trial : search.trials()) {
    if (!search.is_known(trial, accuracy)) continue;
    const Contender seen{as_candidate(search, trial), true};
    const auto same = std::ranges::find(all, trial.method,
                                        [](const Contender& other) { return other.run.method; });
    if (same == all.end()) {
      all.push_back(seen);
    } else if (same->is_vague() || seen.handicapped() < same->handicapped()) {
      *same = seen;
    }
  }
  std::ranges::sort(all, {}, &Contender::handicapped);
  return all;
}

Advice advice_for(const Search& search, double accuracy) {
  Advice advice{.accuracy = accuracy};
  for (const Contender& contender : contenders(search, accuracy)) {
    const Candidate& c = contender.run;
    if (c.method->family == Family::sundials) {
      keep_faster(advice.sundials, c);
    } else {
      keep_faster(c.method->is(Trait::implicit) ? advice.own_implicit : advice.own_explicit, c);
    }
    if (contender.is_vague()) continue;
    if (!advice.take) {
      advice.take = c;
      advice.is_seen = contender.is_seen;
    } else if (!advice.runner_up) {
      advice.runner_up = c;
    }
  }
  if (!advice.take) {
    advice.why = search.most_accurate()    ? "no method is expected to reach this accuracy"
                 : search.trials().empty() ? "no run was made"
                                           : fmt::format("no run reached the end: {}",
                                                         search.trials().back().summary.message);
    return advice;
  }
  return advice;
}

// Makes the advised runs, from the coarsest accuracy on, while there is time. Each run corrects the
// forecast for the next.
void try_out(Search& search, const std::vector<double>& coarse_first,
             std::chrono::steady_clock::time_point begin) {
  double longest = 0;
  for (const double accuracy : coarse_first) {
    const Advice advice = advice_for(search, accuracy);
    if (advice.take) longest = std::max(longest, advice.take->seconds);
  }
  const double allowed =
      std::max(for_runs, std::min(of_the_run * longest, search.seconds_worth_trying()));
  search.stop_after(allowed);
  for (const double accuracy : coarse_first) {
    // An attempt makes the advised run, its check, and runs that may be faster. The advice may then
    // differ: it is tried again.
    constexpr double with_its_check = 3;
    for (int attempt = 0; attempt < 3; ++attempt) {
      const double left = allowed - seconds_since(begin);
      const Advice advice = advice_for(search, accuracy);
      if (!advice.take || advice.is_seen || advice.take->seconds > left) break;
      if (attempt == 0 && with_its_check * advice.take->seconds < left) {
        const double share = left / static_cast<double>(2 * coarse_first.size());
        search.race(search.find(accuracy), accuracy, share);
      } else {
        search.try_once(*advice.take, left);
      }
    }
  }
}

// Measures how fast two motions part whose starts differ by one rounding. It repeats the most
// accurate run that takes at most `for_twin` seconds.
void see_chaos(Advices& all, const Search& search) {
  const Trial* best = search.most_accurate(true, for_twin);
  if (!best) return;
  if (const auto parted = parting_of_twins(search.stage(), *best, for_twin)) {
    all.horizon = parted->horizon;
    all.lyapunov = parted->lyapunov;
  }
}

// Withdraws the advice that no run has confirmed: beyond the horizon no run is right.
void refuse_chaos(Advices& all) {
  for (Advice& advice : all.for_each) {
    if (!advice.take || advice.is_seen) continue;
    advice = {.accuracy = advice.accuracy,
              .why = fmt::format("the motion is chaotic: from t = {:.3g} s on nobody knows its "
                                 "positions; ask for an earlier end, or for --accuracy-of energy",
                                 all.horizon)};
  }
}

// SUNDIALS' methods choose their steps, so their error and time are known from runs only. The
// explicit method is tried for each accuracy, the implicit one for the coarsest, until
// `for_sundials`.
void try_sundials(Search& search, const std::vector<double>& coarse_first,
                  std::chrono::steady_clock::time_point begin) {
  constexpr double tolerance = 0.1;  // of the accuracy
  const auto try_one = [&](const char* name, double accuracy) {
    const double left = for_sundials - seconds_since(begin);
    const double rtol = std::clamp(tolerance * accuracy, 1e-13, 1e-2);
    if (left > 0) search.try_once({find_method(name), rtol, 0, 0}, left);
  };
  for (const double accuracy : coarse_first) try_one("arkode_erk4", accuracy);
  try_one("cvode_bdf", coarse_first.front());
}

Advices of_nothing(const ReducedScene& model, double until, const std::vector<double>& accuracies) {
  Advices all{.largest_stable_step = infinity, .horizon = infinity};
  const Answer rest = solve(model, until, {});
  for (const double accuracy : accuracies) {
    all.for_each.push_back({.accuracy = accuracy,
                            .take = Candidate{rest.method, rest.value, rest.error_estimate, 0},
                            .is_seen = true});
  }
  return all;
}

}  // namespace

double Advice::margin() const {
  if (!take || !runner_up || !(take->seconds > 0)) return infinity;
  return std::max(1.0, runner_up->seconds / take->seconds);
}

Advices advise(const ReducedScene& model, double until, const std::vector<double>& accuracies,
               AccuracyOf of) {
  const auto begin = clock_now();
  for (const double accuracy : accuracies) require_accuracy(accuracy);
  if (accuracies.empty()) throw std::invalid_argument("advise: no accuracy is given");
  if (!(until > 0) || !std::isfinite(until))
    throw std::invalid_argument(fmt::format("until = {:g} is not allowed; it is above 0", until));
  if (model.system().size() == 0) return of_nothing(model, until, accuracies);
  if (!model.system().has_stiffness())
    throw std::invalid_argument(
        "advise: the system has no stiffness K, which its frequencies follow from");
  Search search(model, until, of, infinity);
  Advices all{.horizon = infinity};
  if (search.survey(std::ranges::min(accuracies))) {
    if (search.forecast()) {
      std::vector<double> coarse_first = accuracies;
      std::ranges::sort(coarse_first, std::ranges::greater());
      try_out(search, coarse_first, begin);
      see_chaos(all, search);
      try_sundials(search, coarse_first, begin);
    } else {
      for (const double accuracy : accuracies) search.find(accuracy);
    }
  }
  for (const double accuracy : accuracies) all.for_each.push_back(advice_for(search, accuracy));
  if (of != AccuracyOf::energy && all.horizon <= until) refuse_chaos(all);
  all.w_start = all.w_motion = search.w_start();
  if (search.forecast()) {
    all.w_motion = search.forecast()->w_motion();
    all.own_frequency = search.forecast()->own().at(2);
  }
  all.largest_stable_step = all.w_motion > 0 ? 2 / all.w_motion : infinity;
  all.runs = static_cast<int>(search.trials().size());
  all.seconds = seconds_since(begin);
  return all;
}

Advices advise(const Scene& scene, double until, const std::vector<double>& accuracies,
               AccuracyOf of) {
  const Scene start = scene.starts_at_equilibrium ? settled(scene, scene.name) : scene;
  return advise(ReducedScene(start), until, accuracies, of);
}

}  // namespace qddot::inline measure
