// The error bounds that a search derives from its runs.
#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/measure/advice/search.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// A check may be less accurate than expected. The error is at most this factor times the distance
// to it.
constexpr double margin = 1.4;
// The same for the finer of two runs of one method, if errors fall by the order: 19 of 20 training
// runs were within it.
constexpr double margin_of_finer = 1.2;
// The same for the error that the order predicts from the distance: 19 of 20 training pairs were
// within it, and one was eight times as accurate. The order does not predict all of an error: even
// a much finer run keeps the part `least_left`.
constexpr double margin_of_order = 1.6, least_left = 0.1;
// The same if one run is only slightly finer than the other: the bound then relies on the order
// alone.
constexpr double margin_of_hardly_finer = 4;
// A slightly finer run has at most this fraction of the other's error.
constexpr double hardly_finer = 0.7;

}  // namespace

// The rounding error of a run. A motion computed mode by mode has w_max^2 to its last digit. So a
// slower frequency w has an error of w_max^2 / (2 w) roundings, for a time t.
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
  if (!forecast_) return std::pow(trial.value, power_of_error(*trial.method));
  return truncation(trial) + forecast_->rounding(*trial.method, trial.value);
}

// Implicit steps that do not resolve vibrations may differ much from the forecast. Until an error
// of the method was seen, its runs check no run of another method.
bool Search::is_vague(const Trial& trial) const {
  return forecast_ && trial.method->is(Trait::implicit) && !forecast_->has_learned(*trial.method);
}

// An upper bound of the error of `other` over the error of `trial`, without rounding.
double Search::ratio(const Trial& other, const Trial& trial) const {
  if (other.method->order == 0) return 0;
  if (other.method != trial.method && (!forecast_ || is_vague(other)))
    return std::numeric_limits<double>::infinity();
  const double doubt = forecast_ ? forecast_->doubt(*other.method, *trial.method) : 1;
  const double own = truncation(trial), others = truncation(other);
  return std::isfinite(others) ? others / own * doubt : std::numeric_limits<double>::infinity();
}

double Search::truncation(const Trial& trial) const {
  if (of_ == AccuracyOf::energy || !forecast_) return expected(trial);
  const auto [place, is_new] = truncations_.try_emplace(&trial);
  if (is_new) place->second = forecast_->truncation(*trial.method, trial.value);
  return place->second;
}

bool Search::is_check(const Trial& other, const Trial& trial) const {
  return &other != &trial && other.reached_end() && !trial.is_gamble && !other.is_gamble &&
         ratio(other, trial) * checks <= 1;
}

const Trial* Search::checker(const Trial& trial) const {
  const Trial* best = nullptr;
  for (const Trial& other : trials_) {
    if (is_check(other, trial) && (!best || expected(other) < expected(*best))) best = &other;
  }
  return best;
}

const Trial* Search::most_accurate(bool seen_on_its_way, double longest) const {
  const Trial* best = nullptr;
  for (const Trial& trial : trials_) {
    if (!trial.reached_end() || trial.is_gamble || trial.seconds > longest) continue;
    if (is_vague(trial)) continue;
    if (seen_on_its_way && trial.path.size() < stage_.times().size()) continue;
    if (!best || expected(trial) < expected(*best)) best = &trial;
  }
  return best;
}

// |q - q*| <= |q - q_best| + |q_best - q*|: a bound for the most accurate run gives bounds for all
// others.
std::optional<Bound> Search::bound(const Trial& trial) const {
  const std::optional<Bound> own = bound_by_order(trial);
  const Trial* best = most_accurate();
  if (of_ == AccuracyOf::energy || !trial.reached_end() || !best || best == &trial) return own;
  std::optional<Bound> least = bound_by_order(*best);
  if (!least) least = bound_by_checked(*best);
  if (!least) return own;
  const double by_best = distance(trial, *best) + least->error;
  return own && own->error <= by_best ? own : Bound{by_best, best};
}

// A bound for the most accurate run from the runs that it checks: its error is less than theirs,
// and so less than its distance to them.
std::optional<Bound> Search::bound_by_checked(const Trial& best) const {
  std::optional<Bound> least;
  for (const Trial& other : trials_) {
    const bool is_checked = other.reached_end() && !is_vague(other) && is_check(best, other);
    if (!is_checked && !is_hardly_finer(best, other)) continue;
    const double error = is_checked
                             ? margin_of_finer * likely_distance(other, best) + rounding(best)
                             : bound_by_hardly_finer(other, best);
    if (error < lost && (!least || error < least->error)) least = Bound{error, &other, true};
  }
  return least;
}

// A bound from the expected errors of other, more or less accurate runs.
std::optional<Bound> Search::bound_by_order(const Trial& trial) const {
  if (!trial.reached_end()) return {};
  if (of_ == AccuracyOf::energy)
    return Bound{margin * stage_.energy_error(trial) + 4 * machine_epsilon};
  if (trial.method->order == 0) return Bound{expected(trial)};
  if (const Trial* check = checker(trial)) {
    // A run that is only slightly finer cannot check the trial, but a large distance to it raises
    // the bound.
    constexpr double may_differ = 0.5;
    double most = 0;
    for (const Trial& other : trials_) {
      const bool may_contradict = other.method == trial.method && other.reached_end() &&
                                  !other.is_gamble && ratio(other, trial) < may_differ;
      if (is_check(other, trial) || may_contradict)
        most = std::max(most, likely_distance(trial, other) / (1 - ratio(other, trial)));
    }
    return Bound{margin * most + rounding(trial), check};
  }
  if (const Trial* refined = coarser(trial))
    return Bound{bound_by_coarser(trial, *refined), refined, true};
  for (const Trial& other : trials_) {
    if (is_hardly_finer(other, trial)) return Bound{bound_by_hardly_finer(trial, other), &other};
  }
  return {};
}

// Whether the bound may use the order. Small errors of smooth motions fall by it. A fast run can
// afford a check that needs no order.
bool Search::falls_by_order(const Trial& finer, double error_of_coarser) const {
  constexpr double small = 1e-4, no_time = 5e-3;
  const Method& method = *finer.method;
  return finer.seconds > no_time && error_of_coarser < small && method.knob == Knob::step_size &&
         !method.is(Trait::implicit) && !method.asks(Need::split_forces);
}

double Search::bound_by_coarser(const Trial& trial, const Trial& coarser) const {
  const double gap = likely_distance(coarser, trial);
  const double part = std::max(ratio(trial, coarser), least_left);
  double most = margin_of_finer * gap;
  if (falls_by_order(trial, gap)) most = std::min(most, margin_of_order * gap * part / (1 - part));
  return most + rounding(trial);
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

// The distance of two runs. If it is far below the expected error, that may be chance, as errors
// change sign. The result is then the geometric mean of the two.
double Search::likely_distance(const Trial& trial, const Trial& better) const {
  const double gap = distance(trial, better);
  if (!forecast_) return gap;
  return std::max(gap, std::sqrt(gap * std::min(expected(trial), 1.0)));
}

// Whether `finer` is a run of the same method with much smaller steps. By the order, its error is
// then less than the distance of the two.
bool Search::is_refined_by(const Trial& coarser, const Trial& finer) const {
  const Method& method = *finer.method;
  return coarser.method == &method && method.knob == Knob::step_size &&
         !method.asks(Need::split_forces) && coarser.reached_end() && !coarser.is_gamble &&
         !finer.is_gamble && ratio(finer, coarser) * checks <= 1;
}

// Whether `finer` is a run of the same method that is more accurate by its order, but not by enough
// to be a check.
bool Search::is_hardly_finer(const Trial& finer, const Trial& trial) const {
  return finer.method == trial.method && trial.method->knob == Knob::step_size &&
         !trial.method->is(Trait::implicit) && !trial.method->asks(Need::split_forces) &&
         finer.reached_end() && trial.reached_end() && !finer.is_gamble && !trial.is_gamble &&
         ratio(finer, trial) <= hardly_finer;
}

double Search::bound_by_hardly_finer(const Trial& trial, const Trial& finer) const {
  return margin_of_hardly_finer * likely_distance(trial, finer) / (1 - ratio(finer, trial)) +
         rounding(trial);
}

bool Search::is_known(const Trial& trial, double accuracy) const {
  const auto most = bound(trial);
  return most && most->error <= accuracy;
}

double Search::error(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  if (const Trial* better = checker(trial)) return distance(trial, *better);
  return expected(trial);
}

}  // namespace qddot::inline measure
