#include "qddot/measure/advice/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/frequency_error.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

constexpr double without_end = std::numeric_limits<double>::infinity();
// Steps are chosen this far below the stability limit. The largest frequency is known at some times
// of the motion only, and may be larger between them.
constexpr double below_limit = 0.95;
// Steps are chosen this far below a step size that failed.
constexpr double below_failure = 0.8;
// Implicit methods do not resolve the fast vibrations that w_p contains. Their sensitivity is
// smaller by this factor, the median of the training cases.
constexpr double implicit_share = 0.3;
// Seconds of a dense eigenproblem of n unknowns are about this times n^3.
constexpr double seconds_of_eigenproblem = 1.3e-9;
constexpr double largest_exact = 2000;  // unknowns of a part; the limit of method `exact`
// An error that exceeds its forecast by this factor shows that errors grow exponentially.
constexpr double grows = 30;
// A run gives no forecast for knobs that are finer or coarser by more than this factor.
constexpr double farthest = 100;

bool is_told_by_frequency(const Method& method) {
  return method.order > 0 && has_linear_step(method);
}

}  // namespace

double power_of_error(const Method& method) { return method.knob == Knob::rtol ? 1 : method.order; }

double seconds_of_exact(const ReducedScene& model) {
  constexpr double least = 1e-6;
  if (!model.system().stiffness_is_constant()) return without_end;
  double cubes = 0;
  for (const Index n : model.unknowns_by_part()) {
    if (static_cast<double>(n) > largest_exact) return without_end;
    cubes += std::pow(static_cast<double>(n), 3);
  }
  return least + seconds_of_eigenproblem * cubes;
}

Forecast::Forecast(const Stage& stage, const OwnFrequencies& own, double w_motion,
                   double step_seconds)
    : stage_(stage),
      own_(own),
      w_motion_(w_motion),
      step_seconds_(step_seconds),
      sensitivity_(own.speed * stage.until()) {}

void Forecast::learn_frequencies(const OwnFrequencies& own) {
  own_ = own;
  sensitivity_ = own.speed * stage_.until();
  by_method_.clear();
  by_order_.clear();
}

bool Forecast::has_learned(const Method& method) const {
  if (!is_told_by_frequency(method)) return seen_.contains(&method);
  return method.is(Trait::implicit) ? by_method_.contains(&method)
                                    : by_order_.contains(method.order);
}

double Forecast::doubt(const Method& one, const Method& other) const {
  if (&one == &other) return doubts[0];
  return has_learned(one) && has_learned(other) ? doubts[1] : doubts[2];
}

bool Forecast::has_seen(const Method& method) const {
  return seen_.contains(&method) || by_method_.contains(&method);
}

double Forecast::sensitivity(const Method& method) const {
  const auto own = by_method_.find(&method);
  if (own != by_method_.end()) return sensitivity_ * own->second;
  if (method.is(Trait::implicit)) return sensitivity_ * implicit_share;
  if (by_order_.empty()) return sensitivity_;
  const auto orders_apart = [&](const auto& known) { return std::abs(known.first - method.order); };
  const auto nearest = std::ranges::min_element(by_order_, {}, orders_apart);
  // Corrections of orders that differ by 2 or 4 are correlated, those of orders 2 and 10 are not:
  // the slopes of their logarithms are 0.7 and 0 over the training cases. A growth of errors
  // affects all orders.
  constexpr double unrelated = 8;
  const double related =
      nearest->second > grows ? 1 : std::max(0.0, 1 - orders_apart(*nearest) / unrelated);
  return sensitivity_ * std::pow(nearest->second, related);
}

double Forecast::error(const Method& method, double value) const {
  return truncation(method, value) + rounding(method, value);
}

double Forecast::truncation(const Method& method, double value) const {
  if (is_told_by_frequency(method))
    return sensitivity(method) * frequency_error(method, value * own_.at(method.order));
  const auto seen = seen_.find(&method);
  if (seen == seen_.end()) return method.order == 0 ? 0 : without_end;
  const double least = method.asks(Need::split_forces) ? least_of_split : 0;
  return std::max(
      least, seen->second.error * std::pow(value / seen->second.value, power_of_error(method)));
}

double Forecast::rounding(const Method& method, double value) const {
  // Each step rounds once. Most of that cancels; 0.02 to 0.5 of it adds up in stiff chains.
  constexpr double part = 0.1;
  const double steps =
      method.knob == Knob::step_size && method.order > 0 ? stage_.until() / value : 1;
  return machine_epsilon * (1 + part * steps);
}

double Forecast::seconds(const Method& method, double value) const {
  if (method.order == 0) return seconds_of_exact(stage_.model());
  const auto seen = seen_.find(&method);
  if (seen != seen_.end()) {
    // Half of such a step's time is spent on its inner steps, whose number does not depend on the
    // step size.
    const double share = method.knob == Knob::rtol         ? 1.0 / method.order
                         : method.asks(Need::split_forces) ? 0.5
                                                           : 1;
    return seen->second.seconds * std::pow(seen->second.value / value, share);
  }
  const double steps = std::max(1.0, std::round(stage_.until() / value)) +
                       steps_to_begin(method, stage_.model().system());
  const auto timed = seconds_a_step_.find(&method);
  const double step = timed != seconds_a_step_.end()
                          ? timed->second
                          : step_seconds_ * usual_step_cost(method, stage_.model().system());
  return steps * step + forces_to_begin(method) * step_seconds_;
}

double Forecast::largest_step(const Method& method) const {
  double h = stage_.until();
  const double limit = linear_limit(method);
  if (w_motion_ > 0 && std::isfinite(limit)) h = std::min(h, below_limit * limit / w_motion_);
  const auto failed = failed_.find(&method);
  if (failed != failed_.end()) h = std::min(h, below_failure * failed->second);
  return h;
}

std::optional<Candidate> Forecast::from_steps(const Method& method, double error) const {
  const double until = stage_.until(), w = own_.at(method.order);
  double h = largest_step(method);
  if (w > 0 && sensitivity_ > 0)
    h = std::min(h, largest_h_omega(method, error / sensitivity(method)) / w);
  if (!(h > 0)) return {};
  // The number of steps is a multiple of the number of looks, so that no look shortens a step.
  const double looks = static_cast<double>(stage_.times().size());
  double steps = std::ceil(until / h * (1 - 1e-9));
  if (steps > 4 * looks) steps = looks * std::ceil(steps / looks);
  if (method.recurrence_roots && steps < 2 * method.order) return {};
  h = until / steps;
  return Candidate{&method, h, this->error(method, h), seconds(method, h)};
}

std::optional<Candidate> Forecast::from_seen(const Method& method, double error) const {
  const auto found = seen_.find(&method);
  if (found == seen_.end()) return {};
  const Seen& seen = found->second;
  const double finer = std::pow(seen.error / error, 1 / power_of_error(method));
  if (!(finer < farthest && finer > 1 / farthest)) return {};
  double value = seen.value / finer;
  // The value lies between the largest step that succeeded and the smallest one that failed.
  const auto failed = failed_.find(&method);
  if (failed != failed_.end() && failed->second > seen.value)
    value = std::min(value, std::sqrt(failed->second * seen.value));
  if (method.knob == Knob::rtol) value = std::clamp(value, 1e-14, 0.1);
  if (method.knob == Knob::step_size) {
    value = stage_.until() / std::ceil(stage_.until() / std::min(value, largest_step(method)));
  }
  return Candidate{&method, value, this->error(method, value), seconds(method, value)};
}

std::vector<Candidate> Forecast::candidates(double error, bool explicit_steps) const {
  return candidates([error](const Method&) { return error; }, explicit_steps);
}

std::vector<Candidate> Forecast::candidates(const std::function<double(const Method&)>& error,
                                            bool explicit_steps) const {
  std::vector<Candidate> all;
  const System& system = stage_.model().system();
  for (const Method& method : methods()) {
    if (!applies_to(method, system) || !method.stock_of.empty()) continue;
    if (explicit_steps && (method.is(Trait::implicit) || !is_told_by_frequency(method))) continue;
    std::optional<Candidate> own;
    if (method.order == 0) {
      const double h = stage_.until();
      own = Candidate{&method, h, machine_epsilon, seconds(method, h)};
    } else if (!is_told_by_frequency(method)) {
      own = from_seen(method, error(method));
    } else if (method.order > 1) {
      own = from_steps(method, error(method));
    }
    if (own && std::isfinite(own->seconds)) all.push_back(*own);
  }
  std::ranges::sort(all, {}, &Candidate::seconds);
  return all;
}

void Forecast::learn_error(const Trial& trial, double error) {
  const Method& method = *trial.method;
  if (method.order == 0 || error == 0) return;
  if (!is_told_by_frequency(method)) {
    // An error this large is not proportional to h^order: the step is too long.
    constexpr double too_long = 0.1;
    if (error < too_long || method.knob == Knob::rtol) {
      seen_[&method] = {trial.value, error, trial.seconds};
    } else {
      learn_failure(trial);
    }
    return;
  }
  const double expected =
      sensitivity_ * frequency_error(method, trial.value * own_.at(method.order));
  constexpr double mostly_rounding = 3;
  if (!std::isfinite(expected) || expected == 0) return;
  if (error < mostly_rounding * rounding(method, trial.value)) return;
  by_method_[&method] = error / expected;
  if (!method.is(Trait::implicit)) by_order_[method.order] = error / expected;
}

void Forecast::learn_seconds(const Trial& trial) {
  if (trial.method->knob != Knob::step_size || trial.method->order == 0) return;
  const double steps = std::max(1.0, std::round(stage_.until() / trial.value)) +
                       steps_to_begin(*trial.method, stage_.model().system());
  const double begin = forces_to_begin(*trial.method) * step_seconds_;
  seconds_a_step_[trial.method] = std::max(trial.seconds - begin, 0.3 * trial.seconds) / steps;
}

void Forecast::learn_failure(const Trial& trial) {
  if (trial.method->knob != Knob::step_size) return;
  const auto [place, is_new] = failed_.try_emplace(trial.method, trial.value);
  if (!is_new) place->second = std::min(place->second, trial.value);
}

}  // namespace qddot::inline measure
