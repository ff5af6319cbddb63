#include "qddot/measure/advice/runs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot::inline measure {

Runs::Runs(const ReducedScene& model, double until, AccuracyOf of, double seconds,
           const Scene* drawn, const Rules& rules)
    : limit_(seconds),
      bound_of_w_(frequency_bound(model.system(), model.initial().q)),
      parts_(static_cast<double>(std::max<std::size_t>(1, blocks_of(model.system()).size()))),
      stage_(model, until, of, drawn, rules) {}

double Runs::steps_of_verlet() const {
  return std::isfinite(bound_of_w_) ? std::max(1.0, stage_.until() * bound_of_w_ / 2) : 1;
}

double Runs::work_of_force() const {
  return rules().call * parts_ + static_cast<double>(stage_.model().system().size());
}

double Runs::forces(const Trial& trial) const {
  return static_cast<double>(trial.summary.counts.force_evaluations) / parts_;
}

std::int64_t Runs::forces_within(double work) const {
  constexpr double fewest = 100;  // any run takes some
  return static_cast<std::int64_t>(std::max(fewest, work / work_of_force()));
}

double Runs::seconds_left() const {
  stop_if_interrupted();
  return limit_ - seconds();
}

const Trial& Runs::make(const Method& method, double value, const Limits& limits) {
  all_.push_back(stage_.run(
      method, value, {std::min(limits.seconds, seconds_left()), limits.forces, limits.only_end}));
  stage_.time_again(all_.back());
  return all_.back();
}

void Runs::time_again(const Trial& run) {
  const auto own = std::ranges::find(all_, &run, [](const Trial& trial) { return &trial; });
  stage_.time_again(*own);
}

const Trial& Runs::make_pushed(const Method& method, double value, const Push& push) {
  all_.push_back(stage_.run_pushed(method, value, {.seconds = seconds_left()}, push));
  return all_.back();
}

bool Runs::is_run(const Trial& trial, const Method& method, double value, bool is_pushed) const {
  // Knobs this near give the same error.
  const double same = rules().small * rules().small;
  return trial.method == &method && trial.is_pushed == is_pushed &&
         std::abs(trial.value / value - 1) < same;
}

const Trial* Runs::find(const Method& method, double value, bool is_pushed) const {
  const auto found = std::ranges::find_if(all_, [&](const Trial& trial) {
    return is_run(trial, method, value, is_pushed) && !trial.only_end;
  });
  return found == all_.end() ? nullptr : &*found;
}

bool Runs::has(const Method& method, double value) const {
  return std::ranges::any_of(
      all_, [&](const Trial& trial) { return is_run(trial, method, value, false); });
}

void Runs::look_within_steps(const Method& method, double value) {
  stage_.look_within_steps(
      method, value, {.seconds = seconds_left(), .forces = forces_within(rules().little_work)});
}

void Runs::measure_by(const Trial& trial) {
  stage_.measure_by(trial);
  distances_.clear();
}

double Runs::distance(const Trial& one, const Trial& other) const {
  const auto [place, is_new] =
      distances_.try_emplace(std::minmax(&one, &other, std::less<const Trial*>()));
  if (is_new) place->second = stage_.distance(one, other);
  return place->second;
}

double Runs::distance_on_the_way(const Trial& one, const Trial& other) const {
  const std::vector<double> all = stage_.distances(one, other);
  const auto half =
      static_cast<std::ptrdiff_t>(stage_.of() == AccuracyOf::path ? 0 : all.size() / 2);
  return *std::max_element(all.begin() + half, all.end());
}

}  // namespace qddot::inline measure
