#include "qddot/measure/advice/search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::inline measure {
namespace {

// The fraction of the accuracy that a run is chosen to have as its expected error. The forecast is
// right to a factor of about two.
constexpr double aim = 0.45;
constexpr int most_rounds = 14;
// The distance below which two runs part exponentially.
constexpr double parting = 0.03;

// A look costs as much as about seven forces.
int number_of_looks(double steps, AccuracyOf of) {
  if (!std::isfinite(steps)) steps = 1;
  return static_cast<int>(of == AccuracyOf::positions ? std::clamp(steps / 80, 4.0, 24.0)
                                                      : std::clamp(steps / 20, 20.0, 100.0));
}

struct SeenError {
  const Trial* trial;
  double error;
};

// Whether a run of an implicit method predicts the error of finer ones. Steps that are far too long
// may be right by chance; a finer run with a larger error shows that.
bool is_telling(const SeenError& one, const std::vector<SeenError>& all, double lost) {
  const Method& method = *one.trial->method;
  if (!method.is(Trait::implicit)) return true;
  return one.error < lost && std::ranges::none_of(all, [&](const SeenError& other) {
           return other.trial->method == &method && other.trial->value < one.trial->value &&
                  other.error > one.error;
         });
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
  stage_.time_again(trial);
  if (!forecast_) return trial;
  if (trial.reached_end()) {
    forecast_->learn_seconds(trial);
  } else {
    forecast_->learn_failure(trial);
  }
  learn();
  return trial;
}

void Search::measure_by(const Trial& trial) {
  stage_.measure_by(trial);
  distances_.clear();
}

double Search::distance(const Trial& one, const Trial& other) const {
  const auto [place, is_new] =
      distances_.try_emplace(std::minmax(&one, &other, std::less<const Trial*>()));
  if (is_new) place->second = stage_.distance(one, other);
  return place->second;
}

// The distance of two runs. If they are lost, the distance is extrapolated from its exponential
// growth before.
double Search::lost_distance(const Trial& trial, const Trial& better) const {
  const double end = distance(trial, better);
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
  // The scales of a run with an error below this are accurate enough.
  constexpr double well_enough = 0.01;
  const Trial* best = most_accurate();
  if (best && best != measured_by_ && !(measured_within_ < well_enough)) {
    measure_by(*best);
    measured_by_ = best;
    measured_within_ = expected(*best);
  }
  std::vector<SeenError> seen;
  for (const Trial& trial : trials_) {
    if (!trial.reached_end() || trial.is_gamble) continue;
    if (of_ == AccuracyOf::energy) {
      seen.push_back({&trial, stage_.energy_error(trial)});
    } else if (const Trial* better = checker(trial)) {
      seen.push_back({&trial, lost_distance(trial, *better) / (1 - ratio(*better, trial))});
    }
  }
  for (const SeenError& one : seen) {
    if (of_ == AccuracyOf::energy || is_telling(one, seen, lost))
      forecast_->learn_error(*one.trial, one.error);
  }
  truncations_.clear();
}

bool Search::was_tried(const Candidate& candidate) const {
  constexpr double same = 0.01;
  return std::ranges::any_of(trials_, [&](const Trial& trial) {
    return trial.method == candidate.method && std::abs(trial.value / candidate.value - 1) < same;
  });
}

// The run that is expected to reach the accuracy in the least time. An implicit run must promise a
// much shorter time, since the time of its steps is uncertain.
std::optional<Candidate> Search::fresh(double accuracy) const {
  constexpr double much = 0.2;
  // A smaller error takes error^(-1/order) more steps. This is cheap at high order, so that such
  // methods aim at a smaller error.
  constexpr double lower_by_order = 0.95;
  const auto all = forecast_->candidates([&](const Method& method) {
    return accuracy * std::pow(lower_by_order, std::max(0, method.order - 2));
  });
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& c : all) {
    if (!c.method->is(Trait::implicit)) least = std::min(least, c.seconds);
  }
  // Methods with known errors are preferred by this factor. A forecast without a run may be far
  // off, and such a run needs a check of its own.
  constexpr double unseen = 2;
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

// Whether no explicit run is known to be near the motion's end state.
bool Search::all_are_lost() const {
  return std::ranges::all_of(trials_, [&](const Trial& trial) {
    return !trial.reached_end() || trial.method->is(Trait::implicit) || error(trial) >= lost;
  });
}

double Search::seconds_worth_trying() const {
  constexpr double always = 2, of_the_first = 20;
  return std::max(always, of_the_first * first_seconds_);
}

const Trial* Search::find(double accuracy) {
  if (stage_.model().system().has_massless()) return by_tolerance(accuracy);
  const double most_seconds = seconds_since(begin_) + seconds_worth_trying();
  constexpr double cautious = 0.2, cheaper = 0.8;
  for (int round = 0;; ++round) {
    const Trial *known = nullptr, *promising = nullptr;
    for (const Trial& trial : trials_) {
      if (!trial.reached_end()) continue;
      if ((!known || trial.seconds < known->seconds) && is_known(trial, accuracy)) known = &trial;
      if (!trial.is_gamble && !checker(trial) && expected(trial) <= good_enough * accuracy &&
          (!promising || trial.seconds < promising->seconds))
        promising = &trial;
    }
    if (known) return known;
    if (!forecast_ || round == most_rounds || seconds_left() <= 0 ||
        seconds_since(begin_) > most_seconds)
      return nullptr;
    std::optional<Candidate> next = fresh((all_are_lost() ? cautious : 1) * aim * accuracy);
    if (promising) {
      // The next run replaces the check if it is cheaper and the promising run checks it.
      const std::optional<Candidate> check = check_of(*promising, accuracy);
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

}  // namespace qddot::inline measure
