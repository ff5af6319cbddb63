#include "qddot/measure/advice/runs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot::inline measure {

namespace {

// Rules with fewer looks at a motion of which the end counts, where steps are few and take long: a
// look costs some forces, seventeen by methods of high order.
Rules with_few_looks(Rules rules, double steps, double work_of_force) {
  constexpr double fewest = 6;
  if (steps * work_of_force > rules.small * rules.little_work)
    rules.looks = std::min(rules.looks, std::max(fewest, rules.small * rules.small * steps));
  return rules;
}

}  // namespace

Runs::Runs(const Model& model, double until, AccuracyOf of, double seconds, const Scene* drawn,
           const Rules& rules)
    : limit_(seconds),
      bound_of_w_(frequency_bound(model.system(), model.initial().q)),
      steps_of_verlet_(std::isfinite(bound_of_w_) ? std::max(1.0, until * bound_of_w_ / 2) : 1),
      parts_(static_cast<double>(std::max<std::size_t>(1, model.system().blocks().size()))),
      work_of_force_(rules.call * parts_ + static_cast<double>(model.system().size())),
      stage_(model, until, of, drawn, with_few_looks(rules, steps_of_verlet_, work_of_force_)) {}

double Runs::forces(const Trial& trial) const {
  return static_cast<double>(trial.summary.counts.force_evaluations) / parts_;
}

std::size_t Runs::places(double forces) const {
  return static_cast<std::size_t>(
      std::clamp(rules().small * steps_of_verlet() / forces, 2.0, std::max(2.0, rules().places)));
}

std::int64_t Runs::forces_within(double work) const {
  constexpr double fewest = 100;  // any run takes some
  return static_cast<std::int64_t>(std::max(fewest, work / work_of_force_));
}

double Runs::seconds_left() const {
  stop_if_interrupted();
  return limit_ - seconds();
}

const Trial& Runs::make(const Method& method, double value, const Limits& limits) {
  all_.push_back(stage_.run(
      method, value, {std::min(limits.seconds, seconds_left()), limits.forces, limits.only_end}));
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
  // The last one had the largest limits.
  const auto found = std::find_if(all_.rbegin(), all_.rend(), [&](const Trial& trial) {
    return is_run(trial, method, value, is_pushed) && !trial.only_end;
  });
  return found == all_.rend() ? nullptr : &*found;
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
