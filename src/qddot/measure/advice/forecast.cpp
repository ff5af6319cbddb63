#include "qddot/measure/advice/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/frequency_error.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

}  // namespace

bool is_forecast_by_frequency(const Method& method) {
  return method.order > 1 && !method.is(Trait::implicit) && has_linear_step(method);
}

double power_of_error(const Method& method) { return method.knob == Knob::rtol ? 1 : method.order; }

Forecast::Forecast(const Runs& runs, const std::vector<State>& path, double w_motion)
    : runs_(runs),
      rules_(runs.rules()),
      own_(own_frequencies(runs.stage().model(), path, w_motion,
                           static_cast<int>(runs.places(OwnFrequencies::forces_a_burst)))),
      w_motion_(w_motion),
      force_seconds_(seconds_of_force(runs.stage().model())),
      sensitivity_(own_.speed * runs.stage().until()),
      until_(runs.stage().until()) {}

double Forecast::doubt(const Method& one, const Method& other) const {
  if (&one == &other) return 1;
  return has_seen(one) && has_seen(other) ? rules_.doubt : rules_.doubt_of_two();
}

double Forecast::by_frequency(const Method& method, double value) const {
  return sensitivity_ * frequency_error(method, value * own_.at(method.order));
}

// Corrections of orders that differ by 2 or 4 are correlated, those of orders 2 and 10 are not: the
// slopes of their logarithms are 0.7 and 0 over the training cases.
double Forecast::correction(const Method& method) const {
  if (by_order_.empty()) return 1;
  const auto orders_apart = [&](const auto& known) { return std::abs(known.first - method.order); };
  const auto nearest = std::ranges::min_element(by_order_, {}, orders_apart);
  return std::pow(nearest->second,
                  std::max(0.0, 1 - orders_apart(*nearest) / rules_.unrelated_orders));
}

double Forecast::scale(const Method& method) const {
  const auto seen = seen_.find(&method);
  return seen == seen_.end() ? correction(method)
                             : seen->second.error / by_frequency(method, seen->second.value);
}

double Forecast::error(const Method& method, double value) const {
  if (is_forecast_by_frequency(method)) return scale(method) * by_frequency(method, value);
  const auto seen = seen_.find(&method);
  if (seen == seen_.end()) return method.order == 0 ? 0 : unknown;
  return seen->second.error * std::pow(value / seen->second.value, power_of_error(method));
}

// The number of steps, over that of the run that was seen. For error-controlled methods it falls as
// rtol^(1/order).
double Forecast::steps_over(const Method& method, double value, const Seen& seen) const {
  return std::pow(seen.value / value, method.knob == Knob::rtol ? 1.0 / method.order : 1);
}

double Forecast::forces(const Method& method, double value) const {
  const auto seen = seen_.find(&method);
  if (seen != seen_.end()) return seen->second.forces * steps_over(method, value, seen->second);
  if (!is_forecast_by_frequency(method)) return unknown;
  return forces_a_step(method) * std::max(1.0, std::round(until_ / value));
}

double Forecast::seconds(const Method& method, double value) const {
  const auto seen = seen_.find(&method);
  if (seen != seen_.end()) return seen->second.seconds * steps_over(method, value, seen->second);
  const double a_force = std::isfinite(seconds_a_force_) ? seconds_a_force_ : force_seconds_;
  return a_force * forces(method, value);
}

double Forecast::largest_step(const Method& method) const {
  double h = until_;
  const double limit = linear_limit(method);
  if (w_motion_ > 0 && std::isfinite(limit))
    h = std::min(h, rules_.clearly_below * limit / w_motion_);
  const auto failed = failed_.find(&method);
  if (failed != failed_.end()) h = std::min(h, rules_.clearly_below * failed->second);
  return h;
}

double Forecast::step_by_frequency(const Method& method, double error) const {
  const double w = own_.at(method.order);
  if (!(w > 0 && sensitivity_ > 0)) return until_;
  return largest_h_omega(method, error / sensitivity_) / w;
}

std::optional<Candidate> Forecast::candidate(const Method& method, double error) const {
  const auto seen = seen_.find(&method);
  double value = 0;
  if (is_forecast_by_frequency(method)) {
    value = step_by_frequency(method, error / scale(method));
  } else {
    if (seen == seen_.end()) return {};
    const double finer = std::pow(seen->second.error / error, 1 / power_of_error(method));
    // A run says nothing of knobs that are much finer or coarser.
    const double farthest = 1 / (rules_.small * rules_.small);
    if (!(finer < farthest && finer > 1 / farthest)) return {};
    value = seen->second.value / finer;
  }
  if (method.knob == Knob::rtol) {
    value = std::clamp(value, least_accuracy, rules_.small);
  } else {
    value = std::min(value, largest_step(method));
    if (!(value > 0)) return {};
    const double steps = std::ceil(until_ / value * (1 - 1e-9));
    if (method.recurrence_roots && steps < 2 * method.order) return {};
    value = until_ / steps;
  }
  return Candidate{&method, value, this->error(method, value), seconds(method, value),
                   forces(method, value)};
}

std::vector<Candidate> Forecast::candidates(double error) const {
  std::vector<Candidate> all;
  const System& system = runs_.stage().model().system();
  for (const Method& method : methods()) {
    if (!applies_to(method, system) || !method.stock_of.empty() || method.order == 0) continue;
    if (system.has_massless() && !method.is(Trait::accepts_massless)) continue;
    const auto own = candidate(method, error);
    if (own && std::isfinite(own->seconds)) all.push_back(*own);
  }
  std::ranges::sort(all, {}, &Candidate::seconds);
  return all;
}

double Forecast::error_seen(const Trial& trial, const Trial& by) const {
  const Stage& stage = runs_.stage();
  return stage.of() == AccuracyOf::energy ? stage.energy_error(trial) : runs_.distance(trial, by);
}

void Forecast::learn(const Check& check) {
  for (const Trial& trial : runs_.all()) {
    if (runs_.is_sound(trial) || trial.method->knob != Knob::step_size) continue;
    // Longer steps are expected to fail, too, and all to take too long where one did.
    const double least = trial.summary.outcome == Outcome::over_budget ? 0 : trial.value;
    const auto [place, is_new] = failed_.try_emplace(trial.method, least);
    if (!is_new) place->second = std::min(place->second, least);
  }
  const Trial* by = check.judge();
  double least = by ? check.error_of(*by) : unknown;
  if (!by) {
    for (const Trial& trial : runs_.all()) {
      const double expected = error(*trial.method, trial.value);
      if (!runs_.is_sound(trial) || !(expected < least)) continue;
      least = expected;
      by = &trial;
    }
  }
  if (!by) return;
  for (const Trial& trial : runs_.all()) {
    if (!runs_.is_sound(trial) || trial.is_pushed || &trial == by) continue;
    // An error near that of the other run says nothing.
    const double seen = error_seen(trial, *by);
    if (seen > rules_.doubt * least) learn(trial, seen);
  }
}

void Forecast::learn(const Trial& trial, double error) {
  const Method& method = *trial.method;
  if (method.order == 0 || !(error > 0)) return;
  seen_[&method] = {trial.value, error, trial.seconds, runs_.forces(trial)};
  if (!is_forecast_by_frequency(method)) return;
  seconds_a_force_ = std::min(seconds_a_force_, trial.seconds / runs_.forces(trial));
  const double expected = by_frequency(method, trial.value);
  if (std::isfinite(expected) && expected > 0) {
    by_order_[method.order] = error / expected;
  } else {
    seen_.erase(&method);
  }
}

}  // namespace qddot::inline measure
