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
// Above the distance from a coarser run of the same method, which the finer one is off by at most
// where its order shows: in 19 of 20 training runs within this.
constexpr double margin_of_finer = 1.2;
constexpr int most_rounds = 14;
// Up to here the distance of two runs grows by itself.
constexpr double parting = 0.03;

// Each look costs as much as about seven forces.
int number_of_looks(double steps, AccuracyOf of) {
  if (!std::isfinite(steps)) steps = 1;
  return static_cast<int>(of == AccuracyOf::positions ? std::clamp(steps / 80, 4.0, 24.0)
                                                      : std::clamp(steps / 20, 20.0, 100.0));
}

}  // namespace

double Search::steps_of_verlet() const {
  return std::isfinite(bound_of_w_) ? std::max(1.0, stage_.until() * bound_of_w_ / 2) : 1;
}

Search::Search(const ReducedScene& model, double until, AccuracyOf of, double seconds)
    : of_(of),
      limit_(seconds),
      bound_of_w_(frequency_bound(model.system(), model.initial().q)),
      stage_(model, until, of, number_of_looks(until * bound_of_w_ / 2, of)) {}

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

// What rounding leaves of a run. Of a motion that is computed mode by mode: w_max^2 is known to its
// last digit, so that a slower frequency w is off by w_max^2 / (2 w) of that, for a time t.
double Search::rounding(const Trial& trial) const {
  if (trial.method->order > 0) {
    const double steps = forecast_ ? forecast_->rounding(*trial.method, trial.value) : 0;
    return 4 * machine_epsilon + steps;
  }
  const Scales& scales = stage_.scales();
  const double slow = scales.displacement > 0 ? scales.speed / scales.displacement : 0;
  const double phase = w_start_ * stage_.until() * (slow > 0 ? std::max(1.0, w_start_ / slow) : 1);
  return 4 * machine_epsilon * (1 + phase);
}

double Search::expected(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  if (trial.method->order == 0) return rounding(trial);
  return forecast_ ? forecast_->error(*trial.method, trial.value)
                   : std::pow(trial.value, power_of_error(*trial.method));
}

// What the error of `other` is of that of `trial`, at most, but for rounding.
double Search::ratio(const Trial& other, const Trial& trial) const {
  if (other.method->order == 0) return 0;
  if (!forecast_ && other.method != trial.method) return std::numeric_limits<double>::infinity();
  const double doubt = forecast_ ? forecast_->doubt(*other.method, *trial.method) : 1;
  const double own = truncation(trial), others = truncation(other);
  return std::isfinite(others) ? others / own * doubt : std::numeric_limits<double>::infinity();
}

double Search::truncation(const Trial& trial) const {
  if (of_ == AccuracyOf::energy || !forecast_) return expected(trial);
  return forecast_->truncation(*trial.method, trial.value);
}

bool Search::is_check(const Trial& other, const Trial& trial) const {
  return &other != &trial && other.reached_end() && ratio(other, trial) * checks <= 1;
}

const Trial* Search::checker(const Trial& trial) const {
  const Trial* best = nullptr;
  for (const Trial& other : trials_) {
    if (is_check(other, trial) && (!best || expected(other) < expected(*best))) best = &other;
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
  if (checker(trial)) {
    // What is hardly finer checks nothing, but may contradict.
    constexpr double hardly_finer = 0.5;
    double most = 0;
    for (const Trial& other : trials_) {
      const bool may_contradict =
          other.method == trial.method && other.reached_end() && ratio(other, trial) < hardly_finer;
      if (is_check(other, trial) || may_contradict)
        most = std::max(most, likely_distance(trial, other) / (1 - ratio(other, trial)));
    }
    return margin * most + rounding(trial);
  }
  if (const Trial* refined = coarser(trial))
    return margin_of_finer * likely_distance(*refined, trial) + rounding(trial);
  return {};
}

const Trial* Search::coarser(const Trial& trial) const {
  const Trial* nearest = nullptr;
  double least = lost;
  for (const Trial& other : trials_) {
    if (!is_refined_by(other, trial)) continue;
    const double distance = likely_distance(other, trial);
    if (distance >= least) continue;
    least = distance;
    nearest = &other;
  }
  return nearest;
}

// How far apart two runs are. A distance far below what is expected may be so by chance: errors
// change their sign. It is believed half of the way.
double Search::likely_distance(const Trial& trial, const Trial& better) const {
  const double distance = stage_.distance(trial, better);
  if (!forecast_) return distance;
  return std::max(distance, std::sqrt(distance * std::min(expected(trial), 1.0)));
}

// Whether `finer` is a run of the same method whose order makes it so much more accurate that it
// is off by less than how far they are apart.
bool Search::is_refined_by(const Trial& coarser, const Trial& finer) const {
  const Method& method = *finer.method;
  return coarser.method == &method && method.knob == Knob::step_size &&
         !method.asks(Need::split_forces) && coarser.reached_end() &&
         ratio(finer, coarser) * checks <= 1;
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

// The cheapest run that is expected to be accurate enough to check the trial: one of the same
// method is by its order, so that others have to be clearly cheaper.
std::optional<Candidate> Search::check_of(const Trial& trial) const {
  constexpr double clearly = 0.8;
  std::optional<Candidate> best;
  double shortest = std::numeric_limits<double>::infinity();
  for (const double doubt : Forecast::doubts) {
    for (const Candidate& c :
         forecast_->candidates(truncation(trial) / (chosen_to_check * doubt))) {
      if (c.method->order == 0 || was_tried(c)) continue;
      if (forecast_->doubt(*c.method, *trial.method) > doubt) continue;
      if (c.method->is(Trait::implicit) && c.method != trial.method) continue;
      const double seconds = c.method == trial.method ? clearly * c.seconds : c.seconds;
      if (seconds >= shortest) continue;
      shortest = seconds;
      best = c;
      if (c.method != trial.method) break;
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
    if (forecast_->truncation(*c.method, c.value) > 2 * accuracy || was_tried(c)) continue;
    if (c.method->is(Trait::implicit) && !(may_be_implicit() && c.seconds < much * least)) continue;
    const double seconds = c.seconds * (forecast_->has_learned(*c.method) ? 1 : unseen);
    if (seconds >= shortest) continue;
    shortest = seconds;
    best = c;
  }
  return best;
}

// Whether nothing is known of the motion's end yet.
bool Search::all_are_lost() const {
  return std::ranges::all_of(trials_, [&](const Trial& trial) {
    return !trial.reached_end() || trial.method->is(Trait::implicit) || error(trial) >= lost;
  });
}

const Trial* Search::find(double accuracy) {
  if (stage_.model().system().has_massless()) return by_tolerance(accuracy);
  // Where so much did not do, more hardly will: chaos and rounding are not refined away.
  constexpr double always_allowed = 1, of_the_first = 60;
  const double most_seconds =
      seconds_since(begin_) + std::max(always_allowed, of_the_first * first_seconds_);
  constexpr double cautious = 0.2, cheaper = 0.8;
  for (int round = 0;; ++round) {
    const Trial *known = nullptr, *promising = nullptr;
    for (const Trial& trial : trials_) {
      if (!trial.reached_end()) continue;
      const auto most = bound(trial);
      if (most && *most <= accuracy && (!known || trial.seconds < known->seconds)) known = &trial;
      if (!checker(trial) && expected(trial) <= good_enough * accuracy &&
          (!promising || trial.seconds < promising->seconds))
        promising = &trial;
    }
    if (known) return known;
    if (!forecast_ || round == most_rounds || seconds_left() <= 0 ||
        seconds_since(begin_) > most_seconds)
      return nullptr;
    std::optional<Candidate> next = fresh((all_are_lost() ? cautious : 1) * aim * accuracy);
    if (promising) {
      // A cheaper run than the check, which the promising one checks, does as well.
      const std::optional<Candidate> check = check_of(*promising);
      const bool is_checked =
          next && !next->method->is(Trait::implicit) &&
          truncation(*promising) * forecast_->doubt(*promising->method, *next->method) * checks <=
              next->error;
      if (check && !(is_checked && next->seconds < cheaper * check->seconds)) next = check;
    }
    if (!next) return nullptr;
    run(*next->method, next->value, most_seconds - seconds_since(begin_));
  }
}

}  // namespace qddot::measure
