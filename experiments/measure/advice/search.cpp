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
constexpr double aim = 0.5;
// What is expected to be good enough without a new run, of the accuracy.
constexpr double good_enough = 0.7;
// How many times as accurate a run must be to check another, and is chosen to be.
constexpr double checks = 3, chosen_to_check = 5;
// Above the distance from a check: what the check itself may be off, and what looks at some times
// leave out.
constexpr double margin = 1.3;
constexpr int most_rounds = 12;
// Two runs that far apart have nothing to do with each other: nothing follows for the errors.
constexpr double lost = 0.1, follows = 0.03;

// Looks at a run of so many steps cost little beside it.
int number_of_looks(double steps, AccuracyOf of) {
  const double least = of == AccuracyOf::positions ? 4 : 20, most = of == AccuracyOf::positions ? 40 : 100;
  return static_cast<int>(std::clamp(steps / 20, least, most));
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
  // To search for w_max costs about a hundred forces and a half.
  constexpr double worth_searching = 2000;
  w_start_ = bound;
  if (stage_.until() * bound > worth_searching || system.size() < 100)
    w_start_ = quick_frequency(system, model.initial().q);
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
  return true;
}

double Search::expected(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return trial.energy_error;
  if (has_linear_step(*trial.method) || trial.method->order == 0)
    return forecast_->error(*trial.method, trial.value);
  return trial.value;
}

const Trial* Search::checker(const Trial& trial) const {
  const Trial* best = nullptr;
  for (const Trial& other : trials_) {
    if (other.reached_end() && (!best || expected(other) < expected(*best))) best = &other;
  }
  return best && checks * expected(*best) <= expected(trial) ? best : nullptr;
}

std::optional<double> Search::bound(const Trial& trial) const {
  if (!trial.reached_end()) return {};
  if (of_ == AccuracyOf::energy) return margin * trial.energy_error;
  if (trial.method->order == 0) return expected(trial);
  if (const Trial* better = checker(trial))
    return margin * stage_.distance(trial, *better, of_) + 4 * machine_epsilon;
  return {};
}

double Search::error(const Trial& trial) const {
  if (const Trial* better = checker(trial); better && of_ != AccuracyOf::energy)
    return stage_.distance(trial, *better, of_);
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
  for (const Trial& trial : trials_) {
    if (!trial.reached_end()) continue;
    if (of_ == AccuracyOf::energy) {
      forecast_->learn_error(trial, trial.energy_error);
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
    const auto next = forecast_->candidates(aim * accuracy);
    const auto fresh =
        std::ranges::find_if(next, [&](const Candidate& c) { return !was_tried(c); });
    constexpr double rather_checked = 1.5;
    if (promising && (fresh == next.end() || promising->seconds < rather_checked * fresh->seconds)) {
      const double needed = expected(*promising) / chosen_to_check;
      const auto checkers = forecast_->candidates(needed);
      const auto check =
          std::ranges::find_if(checkers, [&](const Candidate& c) { return !was_tried(c); });
      if (check == checkers.end()) return nullptr;
      run(*check->method, check->value, limit_);
    } else if (fresh != next.end()) {
      run(*fresh->method, fresh->value, limit_);
    } else {
      return nullptr;
    }
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
