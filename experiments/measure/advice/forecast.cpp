#include "qddot/measure/advice/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/frequency_error.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::measure {
namespace {

constexpr double without_end = std::numeric_limits<double>::infinity();
// Steps are that far below the limit of stability over the motion, which is seen at some times only.
constexpr double below_limit = 0.95;
// After a step that did not hold.
constexpr double below_failure = 0.8;
// Errors of implicit methods come from slower vibrations than w_p says, for they leave the fast ones
// out: by this much in the median of the training cases.
constexpr double implicit_share = 0.3;
// Seconds of a dense eigenproblem of n unknowns are about this times n^3.
constexpr double seconds_of_eigenproblem = 1.3e-9;
constexpr double largest_exact = 2000;  // as method `exact` has it
// What is left of digits where vibrations are followed for a phase w t.
double rounding(double phase) { return 4 * machine_epsilon * (1 + phase); }

double cube_of_unknowns(const ReducedScene& model) {
  double sum = 0;
  for (const Index n : model.unknowns_by_part()) {
    if (static_cast<double>(n) > largest_exact) return without_end;
    sum += std::pow(static_cast<double>(n), 3);
  }
  return sum;
}

}  // namespace

Forecast::Forecast(const Stage& stage, const OwnFrequencies& own, double w_motion,
                   double step_seconds)
    : stage_(stage),
      own_(own),
      w_motion_(w_motion),
      step_seconds_(step_seconds),
      sensitivity_(own.speed * stage.until()) {}

bool Forecast::has_learned(const Method& method) const {
  return method.is(Trait::implicit) ? by_method_.contains(&method)
                                    : by_order_.contains(method.order);
}

double Forecast::doubt(const Method& one, const Method& other) const {
  if (&one == &other) return 1;
  return has_learned(one) && has_learned(other) ? 1.5 : 4;
}

double Forecast::sensitivity(const Method& method) const {
  if (method.is(Trait::implicit)) {
    const auto own = by_method_.find(&method);
    return sensitivity_ * (own == by_method_.end() ? implicit_share : own->second);
  }
  if (by_order_.empty()) return sensitivity_;
  const auto nearest = std::ranges::min_element(by_order_, {}, [&](const auto& known) {
    return std::abs(known.first - method.order);
  });
  return sensitivity_ * nearest->second;
}

double Forecast::error(const Method& method, double h) const {
  if (method.order == 0) return rounding(w_motion_ * stage_.until());
  return sensitivity(method) * frequency_error(method, h * own_.at(method.order)) +
         2 * machine_epsilon;
}

double Forecast::seconds(const Method& method, double h) const {
  if (method.order == 0) return 2e-6 + seconds_of_eigenproblem * cube_of_unknowns(stage_.model());
  const double steps = std::max(1.0, std::round(stage_.until() / h));
  const auto timed = seconds_a_step_.find(&method);
  const double step = timed != seconds_a_step_.end()
                          ? timed->second
                          : step_seconds_ * usual_step_cost(method, stage_.model().system().size());
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

std::vector<Candidate> Forecast::candidates(double error) const {
  std::vector<Candidate> all;
  const System& system = stage_.model().system();
  for (const Method& method : methods()) {
    if (!applies_to(method, system) || !method.stock_of.empty()) continue;
    if (system.has_massless() && !method.is(Trait::accepts_massless)) continue;
    if (method.order == 0) {
      if (this->error(method, stage_.until()) <= error && std::isfinite(seconds(method, 1)))
        all.push_back({&method, stage_.until(), this->error(method, stage_.until()),
                       seconds(method, stage_.until())});
      continue;
    }
    if (method.order == 1 || !has_linear_step(method)) continue;
    if (!std::isfinite(usual_step_cost(method, system.size()))) continue;
    const double w = own_.at(method.order);
    double h = largest_step(method);
    if (w > 0 && sensitivity_ > 0)
      h = std::min(h, largest_h_omega(method, error / sensitivity(method)) / w);
    if (!(h > 0)) continue;
    // A whole number of steps from one look to the next.
    const double looks = static_cast<double>(stage_.times().size());
    double steps = std::ceil(stage_.until() / h * (1 - 1e-9));
    if (steps > 4 * looks) steps = looks * std::ceil(steps / looks);
    if (method.recurrence_roots && steps < 2 * method.order) continue;
    h = stage_.until() / steps;
    all.push_back({&method, h, this->error(method, h), seconds(method, h)});
  }
  std::ranges::sort(all, {}, &Candidate::seconds);
  return all;
}

void Forecast::learn_error(const Trial& trial, double error) {
  const Method& method = *trial.method;
  if (!has_linear_step(method) || method.order == 0 || sensitivity_ == 0) return;
  const double expected =
      sensitivity_ * frequency_error(method, trial.value * own_.at(method.order));
  if (!std::isfinite(expected) || expected == 0 || error == 0) return;
  if (method.is(Trait::implicit)) {
    by_method_[&method] = error / expected;
  } else {
    by_order_[method.order] = error / expected;
  }
}

void Forecast::learn_seconds(const Trial& trial) {
  if (trial.method->knob != Knob::step_size || trial.method->order == 0) return;
  const double steps = std::max(1.0, std::round(stage_.until() / trial.value));
  const double begin = forces_to_begin(*trial.method) * step_seconds_;
  seconds_a_step_[trial.method] = std::max(trial.seconds - begin, 0.3 * trial.seconds) / steps;
}

void Forecast::learn_failure(const Trial& trial) {
  if (trial.method->knob != Knob::step_size) return;
  const auto [place, is_new] = failed_.try_emplace(trial.method, trial.value);
  if (!is_new) place->second = std::min(place->second, trial.value);
}

}  // namespace qddot::measure
