#include "qddot/measure/advice/search.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/analysis/frequency_bound.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::measure {
namespace {

// Of the accuracy, what a run is chosen to miss by: it is known to a factor of two or so before.
constexpr double aim = 0.45;
// What is expected to be good enough without a new run, of the accuracy.
constexpr double good_enough = 0.6;
// How many times as accurate a run must be to check another, and is chosen to be.
constexpr double checks = 3, chosen_to_check = 3.5;
// Above the distance from a check: what the check itself may be off, and what looks at some times
// leave out.
constexpr double margin = 1.4;
constexpr int most_rounds = 12;
// Two runs that far apart have nothing to do with each other: nothing follows for the errors.
constexpr double lost = 0.1, follows = 0.03;

// Each look costs as much as some forces.
int number_of_looks(double steps, AccuracyOf of) {
  const bool at_end = of == AccuracyOf::positions;
  return static_cast<int>(at_end ? std::clamp(steps / 60, 4.0, 24.0) : std::clamp(steps / 20, 20.0, 100.0));
}

double steps_of_verlet(const ReducedScene& model, double until) {
  const System& system = model.system();
  if (system.size() == 0 || !system.has_stiffness()) return 1;
  const double w = frequency_bound(system, model.initial().q);
  return std::isfinite(w) ? until * w / 2 : 1;
}

}  // namespace

Search::Search(const ReducedScene& model, double until, AccuracyOf of, double seconds)
    : of_(of),
      limit_(seconds),
      stage_(model, until, number_of_looks(steps_of_verlet(model, until), of)) {}

double Search::seconds_left() const {
  stop_if_interrupted();
  return limit_ - seconds_since(begin_);
}

Trial& Search::run(const Method& method, double value, double seconds) {
  trials_.push_back(stage_.run(method, value, std::min(seconds, seconds_left())));
  Trial& trial = trials_.back();
  if (forecast_) trial.expected = forecast_->error(method, value);
  if (forecast_) {
    if (trial.reached_end()) forecast_->learn_seconds(trial);
    if (!trial.reached_end() && trial.summary.outcome != Outcome::over_budget)
      forecast_->learn_failure(trial);
    learn();
  }
  return trial;
}

bool Search::survey() {
  const ReducedScene& model = stage_.model();
  const System& system = model.system();
  const double bound = frequency_bound(system, model.initial().q);
  // An exact search is for small systems; thirty products come within some percent from below, and
  // cost as much as about a hundred forces.
  constexpr Index small = 300;
  constexpr double worth_searching = 600, from_below = 1.02;
  w_start_ = bound;
  if (system.size() <= small) {
    w_start_ = largest_frequency(system, model.initial().q);
  } else if (stage_.until() * bound > 2 * worth_searching) {
    w_start_ = std::min(bound, from_below * frequency_at_least(system, model.initial().q));
  }
  constexpr double first_step = 0.9, shorter = 0.75;
  double looks = static_cast<double>(stage_.times().size());
  double steps = std::max(8.0, std::ceil(stage_.until() * w_start_ / (2 * first_step)));
  Trial* first = nullptr;
  for (int attempt = 0; attempt < 4; ++attempt, steps = std::ceil(steps / shorter)) {
    steps = looks * std::ceil(steps / looks);
    first = &run(*find_method("verlet"), stage_.until() / steps, limit_);
    if (first->reached_end() && first->summary.energy_growth < 10) break;
  }
  if (!first->reached_end()) return false;
  double w = w_start_;
  if (!system.stiffness_is_constant()) {
    const std::size_t seen = std::clamp<std::size_t>(static_cast<std::size_t>(steps / 100), 1, 12);
    double most = bound;
    for (std::size_t i = 1; i <= seen; ++i) {
      const State& at = first->path[i * first->path.size() / seen - 1];
      most = std::max(most, frequency_bound(system, at.q));
    }
    w *= most / bound;
  }
  const int bursts = static_cast<int>(std::clamp(steps / 80, 2.0, 16.0));
  const double step_seconds = first->seconds / steps;
  forecast_.emplace(stage_, own_frequencies(model, first->path, w, bursts), w, step_seconds);
  forecast_->learn_seconds(*first);
  first->expected = expected(*first);
  learn();
  return true;
}

double Search::expected(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  return forecast_->error(*trial.method, trial.value);
}

// What the error of `other` is of that of `trial`, at most.
double Search::ratio(const Trial& other, const Trial& trial) const {
  return expected(other) / expected(trial) * forecast_->doubt(*other.method, *trial.method);
}

const Trial* Search::checker(const Trial& trial) const {
  const Trial* best = nullptr;
  for (const Trial& other : trials_) {
    if (&other != &trial && other.reached_end() && ratio(other, trial) * checks <= 1 &&
        (!best || ratio(other, trial) < ratio(*best, trial)))
      best = &other;
  }
  return best;
}

std::optional<double> Search::bound(const Trial& trial) const {
  if (!trial.reached_end()) return {};
  if (of_ == AccuracyOf::energy) return margin * stage_.energy_error(trial);
  if (trial.method->order == 0) return expected(trial);
  if (const Trial* better = checker(trial)) {
    return margin * stage_.distance(trial, *better, of_) / (1 - ratio(*better, trial)) +
           4 * machine_epsilon;
  }
  return {};
}

double Search::error(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  if (const Trial* better = checker(trial)) return stage_.distance(trial, *better, of_);
  return expected(trial);
}

// Where two runs have parted, the distance that they would have come to had it gone on growing.
double Search::lost_distance(const Trial& trial, const Trial& better) const {
  const double end = stage_.distance(trial, better, of_);
  if (end < lost) return end;
  const auto& times = stage_.times();
  std::size_t last = 0;
  std::vector<double> distances;
  for (std::size_t i = 0; i < times.size(); ++i) {
    distances.push_back(stage_.distance_at(trial, better, i));
    if (distances.back() < follows) last = i;
  }
  if (last < 2 || distances[last / 2] == 0) return std::max(end, 1.0);
  const double rate =
      std::log(distances[last] / distances[last / 2]) / (times[last] - times[last / 2]);
  return std::max(end, distances[last] * std::exp(std::min(rate * (times.back() - times[last]), 80.0)));
}

void Search::learn() {
  const Trial* best = nullptr;
  for (const Trial& trial : trials_) {
    if (trial.reached_end() && (!best || expected(trial) < expected(*best))) best = &trial;
  }
  // A run that misses by a hundredth measures the motion well enough.
  constexpr double well_enough = 0.01;
  if (best && best != measured_by_ && !(measured_within_ < well_enough)) {
    stage_.measure_by(*best);
    measured_by_ = best;
    measured_within_ = expected(*best);
  }
  for (const Trial& trial : trials_) {
    if (!trial.reached_end()) continue;
    if (of_ == AccuracyOf::energy) {
      forecast_->learn_error(trial, stage_.energy_error(trial));
    } else if (const Trial* better = checker(trial)) {
      forecast_->learn_error(trial, lost_distance(trial, *better));
    }
  }
}

bool Search::was_tried(const Candidate& candidate) const {
  return std::ranges::any_of(trials_, [&](const Trial& trial) {
    return trial.method == candidate.method && std::abs(trial.value / candidate.value - 1) < 0.01;
  });
}

// The cheapest run that is expected to be accurate enough to check the trial.
std::optional<Candidate> Search::check_of(const Trial& trial) const {
  const double error = expected(trial);
  std::optional<Candidate> best;
  for (const double doubt : {1.0, 1.5, 4.0}) {
    for (const Candidate& c : forecast_->candidates(error / (chosen_to_check * doubt))) {
      if (forecast_->doubt(*c.method, *trial.method) > doubt || was_tried(c) ||
          c.method->is(Trait::implicit) != trial.method->is(Trait::implicit))
        continue;
      if (!best || c.seconds < best->seconds) best = c;
      break;
    }
  }
  return best;
}

// The run that is expected to come to the accuracy in the least time. Implicit ones only where they
// promise much: what a step of theirs takes is known badly before, and they are stopped where they
// do not keep it.
std::optional<Candidate> Search::fresh(double accuracy) const {
  constexpr double much = 0.2;
  std::optional<Candidate> best;
  double own = std::numeric_limits<double>::infinity();
  const auto all = forecast_->candidates(accuracy);
  for (const Candidate& c : all) {
    if (was_tried(c)) continue;
    if (!c.method->is(Trait::implicit)) own = std::min(own, c.seconds);
  }
  for (const Trial& trial : trials_) {
    if (trial.reached_end() && expected(trial) <= accuracy) own = std::min(own, trial.seconds);
  }
  for (const Candidate& c : all) {
    if (was_tried(c)) continue;
    if (!c.method->is(Trait::implicit) || c.seconds < much * own) return c;
  }
  return {};
}

const Trial* Search::find(double accuracy) {
  for (int round = 0; round < most_rounds && seconds_left() > 0; ++round) {
    const Trial *known = nullptr, *promising = nullptr;
    for (const Trial& trial : trials_) {
      if (!trial.reached_end()) continue;
      const auto most = bound(trial);
      if (most && *most <= accuracy && (!known || trial.seconds < known->seconds)) known = &trial;
      if (!most && expected(trial) <= good_enough * accuracy &&
          (!promising || trial.seconds < promising->seconds))
        promising = &trial;
    }
    if (known) return known;
    std::optional<Candidate> next = promising ? check_of(*promising) : std::nullopt;
    if (!next) next = fresh(aim * accuracy);
    if (!next) return nullptr;
    run(*next->method, next->value, limit_);
  }
  return nullptr;
}

const Trial* Search::race(const Trial* answer, double accuracy, double seconds) {
  constexpr double clearly_faster = 0.9;
  const double until = seconds_since(begin_) + seconds;
  while (answer && seconds_since(begin_) < until && seconds_left() > 0) {
    const auto next = forecast_->candidates(good_enough * accuracy);
    const auto faster = std::ranges::find_if(next, [&](const Candidate& c) {
      return !was_tried(c) && c.seconds < clearly_faster * answer->seconds;
    });
    if (faster == next.end() || seconds_since(begin_) + faster->seconds > until) break;
    const Trial& trial = run(*faster->method, faster->value, 2 * answer->seconds);
    const auto most = bound(trial);
    if (most && *most <= accuracy && trial.seconds < answer->seconds) answer = &trial;
  }
  return answer;
}

}  // namespace qddot::measure
