// The run that a search chooses to check another one.
#include <algorithm>
#include <limits>

#include "qddot/measure/advice/search.hpp"

namespace qddot::inline measure {
namespace {

// The ratio of the expected errors of a run and of the check chosen for it.
constexpr double chosen_to_check = 2.4;
// A smaller ratio, for a run whose expected error is at most the fraction `far_within` of the
// accuracy.
constexpr double chosen_to_check_roughly = 1.6, far_within = 1.0 / 30;

}  // namespace

// A coarser run of the same method, which is cheaper than the trial. If errors fall by the order,
// it bounds the trial's error. None exists near the stability limit.
std::optional<Candidate> Search::coarser_check_of(const Trial& trial, double accuracy) const {
  constexpr double times = 8, at_least = 4, margin = 1.7;
  const double error = expected(trial);
  if (!falls_by_order(trial, times * error) || margin * error > accuracy || coarser(trial))
    return {};
  for (const Candidate& c : forecast_->candidates(times * truncation(trial))) {
    if (c.method == trial.method && !was_tried(c) && c.error > at_least * error) return c;
  }
  return {};
}

// The cheapest run that is expected to check the trial. A run of the same method is preferred,
// since its order alone makes it a check: others must be clearly cheaper.
std::optional<Candidate> Search::check_of(const Trial& trial, double accuracy) const {
  constexpr double clearly = 0.8;
  std::optional<Candidate> best = coarser_check_of(trial, accuracy);
  if (best) return best;
  double shortest = std::numeric_limits<double>::infinity();
  const bool is_roughly_checked = std::ranges::any_of(
      trials_, [&](const Trial& other) { return is_hardly_finer(other, trial); });
  const bool roughly = !is_roughly_checked && expected(trial) < far_within * accuracy &&
                       !trial.method->is(Trait::implicit);
  const auto error_of_check = [&](const Method& method) {
    const bool is_own = &method == trial.method;
    return truncation(trial) / (roughly && is_own ? chosen_to_check_roughly : chosen_to_check);
  };
  for (const double doubt : Forecast::doubts) {
    const auto error = [&](const Method& method) { return error_of_check(method) / doubt; };
    for (const Candidate& c : forecast_->candidates(error)) {
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

}  // namespace qddot::inline measure
