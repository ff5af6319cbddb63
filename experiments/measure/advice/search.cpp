#include "qddot/measure/advice/search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "qddot/analysis/frequency_bound.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::measure {
namespace {

// Fraction of the accuracy that a run is chosen to miss by, as it is known to a factor of about two
// before.
constexpr double aim = 0.45;
// How many times as accurate a run must be to check another, and is chosen to be.
constexpr double checks = 3, chosen_to_check = 3.5;
// Above the distance from a check: that this is not quite as accurate as is expected.
constexpr double margin = 1.4;
constexpr int most_rounds = 14;
// Two runs that are `lost` apart have nothing to do with each other; up to `parting` their distance
// grows by itself.
constexpr double lost = 0.1, parting = 0.03;

// Each look costs as much as some forces.
int number_of_looks(double steps, AccuracyOf of) {
  return static_cast<int>(of == AccuracyOf::positions ? std::clamp(steps / 60, 4.0, 24.0)
                                                      : std::clamp(steps / 20, 20.0, 100.0));
}

}  // namespace

double Search::steps_of_verlet(const ReducedScene& model, double until) {
  const double w = frequency_bound(model.system(), model.initial().q);
  return std::isfinite(w) ? std::max(1.0, until * w / 2) : 1;
}

Search::Search(const ReducedScene& model, double until, AccuracyOf of, double seconds)
    : of_(of),
      limit_(seconds),
      stage_(model, until, of, number_of_looks(steps_of_verlet(model, until), of)) {}

double Search::seconds_left() const {
  stop_if_interrupted();
  return limit_ - seconds_since(begin_);
}

Trial& Search::run(const Method& method, double value, double seconds) {
  trials_.push_back(stage_.run(method, value, std::min(seconds, seconds_left())));
  Trial& trial = trials_.back();
  if (!forecast_) return trial;
  if (trial.reached_end()) {
    forecast_->learn_seconds(trial);
  } else {
    forecast_->learn_failure(trial);
  }
  learn();
  return trial;
}

// What rounding leaves of a motion that is computed mode by mode: w_max^2 is known to its last
// digit, so that a slower frequency w is off by w_max^2 / (2 w) of that, for a time t.
double Search::rounding() const {
  const Scales& scales = stage_.scales();
  const double slow = scales.displacement > 0 ? scales.speed / scales.displacement : 0;
  const double phase = w_start_ * stage_.until() * (slow > 0 ? std::max(1.0, w_start_ / slow) : 1);
  return 4 * machine_epsilon * (1 + phase);
}

double Search::expected(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  if (trial.method->order == 0) return rounding();
  return forecast_ ? forecast_->error(*trial.method, trial.value)
                   : std::pow(trial.value, power_of_error(*trial.method));
}

// What the error of `other` is of that of `trial`, at most.
double Search::ratio(const Trial& other, const Trial& trial) const {
  if (!forecast_ && other.method != trial.method) return std::numeric_limits<double>::infinity();
  const double doubt = forecast_ ? forecast_->doubt(*other.method, *trial.method) : 1;
  const double own = expected(trial), others = expected(other);
  return std::isfinite(others) ? others / own * doubt : std::numeric_limits<double>::infinity();
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

const Trial* Search::most_accurate(bool seen_on_its_way) const {
  const Trial* best = nullptr;
  for (const Trial& trial : trials_) {
    if (!trial.reached_end()) continue;
    if (seen_on_its_way && trial.path.size() < stage_.times().size()) continue;
    if (!best || expected(trial) < expected(*best)) best = &trial;
  }
  return best;
}

std::optional<double> Search::bound(const Trial& trial) const {
  if (!trial.reached_end()) return {};
  if (of_ == AccuracyOf::energy) return margin * stage_.energy_error(trial) + 4 * machine_epsilon;
  if (trial.method->order == 0) return expected(trial);
  const Trial* better = checker(trial);
  if (!better) return {};
  const double distance = stage_.distance(trial, *better);
  // A distance far below what is expected may be so by chance: errors change their sign. It is
  // believed half of the way.
  const double likely =
      forecast_ ? std::max(distance, std::sqrt(distance * std::min(expected(trial), 1.0)))
                : distance;
  return margin * likely / (1 - ratio(*better, trial)) + 4 * machine_epsilon;
}

double Search::error(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  if (const Trial* better = checker(trial)) return stage_.distance(trial, *better);
  return expected(trial);
}

// How far apart two runs are or, where they are lost, would be had their distance gone on growing.
double Search::lost_distance(const Trial& trial, const Trial& better) const {
  const double end = stage_.distance(trial, better);
  if (end < lost) return end;
  const auto& times = stage_.times();
  const std::vector<double> distances = stage_.distances(trial, better);
  std::size_t last = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] < parting) last = i;
  }
  if (last < 2) return std::max(end, 1.0);
  const double before = distances[last / 2];
  if (before == 0) return std::max(end, 1.0);
  constexpr double largest_exponent = 80;
  const double rate = std::log(distances[last] / before) / (times[last] - times[last / 2]);
  const double exponent = std::min(rate * (times.back() - times[last]), largest_exponent);
  return std::max(end, distances[last] * std::exp(exponent));
}

void Search::learn() {
  // A run that misses by a hundredth measures the motion well enough.
  constexpr double well_enough = 0.01;
  const Trial* best = most_accurate();
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
      const double error = lost_distance(trial, *better);
      // Steps that are far too long say nothing of those that are not.
      if (error < lost || !trial.method->is(Trait::implicit)) forecast_->learn_error(trial, error);
    }
  }
}

bool Search::was_tried(const Candidate& candidate) const {
  constexpr double same = 0.01;
  return std::ranges::any_of(trials_, [&](const Trial& trial) {
    return trial.method == candidate.method && std::abs(trial.value / candidate.value - 1) < same;
  });
}

// The cheapest run that is expected to be accurate enough to check the trial.
std::optional<Candidate> Search::check_of(const Trial& trial) const {
  std::optional<Candidate> best;
  for (const double doubt : Forecast::doubts) {
    for (const Candidate& c : forecast_->candidates(expected(trial) / (chosen_to_check * doubt))) {
      if (c.method->order == 0 || was_tried(c)) continue;
      if (forecast_->doubt(*c.method, *trial.method) > doubt) continue;
      if (c.method->is(Trait::implicit) && c.method != trial.method) continue;
      if (!best || c.seconds < best->seconds) best = c;
      break;
    }
  }
  return best;
}

// The run that is expected to come to the accuracy in the least time. Implicit ones only where they
// promise much: what a step of theirs takes is known badly before.
std::optional<Candidate> Search::fresh(double accuracy) const {
  constexpr double much = 0.2;
  const auto all = forecast_->candidates(accuracy);
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& c : all) {
    if (!c.method->is(Trait::implicit)) least = std::min(least, c.seconds);
  }
  // A method that was seen is preferred to one that promises as much.
  constexpr double unseen = 1.2;
  std::optional<Candidate> best;
  double shortest = std::numeric_limits<double>::infinity();
  for (const Candidate& c : all) {
    if (c.error > 2 * accuracy || was_tried(c)) continue;
    if (c.method->is(Trait::implicit) && !(may_be_implicit() && c.seconds < much * least)) continue;
    const double seconds = c.seconds * (forecast_->has_learned(*c.method) ? 1 : unseen);
    if (seconds >= shortest) continue;
    shortest = seconds;
    best = c;
  }
  return best;
}

const Trial* Search::find(double accuracy) {
  if (stage_.model().system().has_massless()) return by_tolerance(accuracy);
  // Where so much did not do, more hardly will: chaos and rounding are not refined away.
  constexpr double always_allowed = 1, of_the_first = 60;
  const double most_seconds =
      seconds_since(begin_) + std::max(always_allowed, of_the_first * first_seconds_);
  for (int round = 0; round < most_rounds; ++round) {
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
    if (!forecast_ || seconds_left() <= 0 || seconds_since(begin_) > most_seconds) return nullptr;
    std::optional<Candidate> next = promising ? check_of(*promising) : std::nullopt;
    if (!next) next = fresh(aim * accuracy);
    if (!next) return nullptr;
    run(*next->method, next->value, most_seconds - seconds_since(begin_));
  }
  return nullptr;
}

}  // namespace qddot::measure
