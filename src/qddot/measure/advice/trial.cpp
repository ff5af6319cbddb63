#include "qddot/measure/advice/trial.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/motion/rest.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

std::vector<Index> broken_springs(const Trial& trial) {
  std::vector<Index> numbers;
  for (const Break& one : trial.summary.breaks) numbers.push_back(one.number);
  std::ranges::sort(numbers);
  return numbers;
}

Stage::Stage(const Model& model, double until, AccuracyOf of, const Scene* drawn,
             const Rules& rules)
    : model_(model),
      until_(until),
      of_(of),
      drawn_(drawn),
      rules_(rules),
      times_(random_times(
          until, static_cast<std::int64_t>(of == AccuracyOf::positions ? rules.looks
                                                                       : rules.looks_at_a_path))) {}

std::unique_ptr<Integrator> Stage::integrator(const Model& model, const Method& method,
                                              double value, const Limits& limits) const {
  Options options = options_for(method, value, model);
  options.most_forces = limits.forces;
  return make_integrator(method, model.system(), options);
}

Trial Stage::run_by(Integrator& integrator, const Model& model, const State& start,
                    const Method& method, double value, const Limits& limits,
                    const See& see_step) const {
  Trial trial{.method = &method,
              .value = value,
              .only_end = limits.only_end && of_ == AccuracyOf::positions};
  State state = start;
  const Deadline deadline(limits.seconds, alarm_);
  const double energy = model.energy(start) + energy_lost_at_start_;
  const auto see_energy = [&](const State& seen) {
    const double gain = model.energy(seen) - energy;
    trial.energy_gain = std::max(trial.energy_gain, gain);
    trial.energy_gap = std::max(trial.energy_gap, std::abs(gain));
  };
  Observer each{trial.only_end ? std::vector{until_} : times_,
                [&](const State& seen) { trial.path.push_back(seen); }, see_step};
  if (!each.step && of_ == AccuracyOf::energy) each.step = see_energy;
  trial.seconds = seconds_of(
      [&] { trial.summary = integrator.advance(state, until_, each, deadline.token()); });
  for (const State& seen : trial.path) see_energy(seen);
  if (!trial.reached_end()) stop_if_interrupted();
  return trial;
}

void Stage::begin_in_balance(const Method& method) {
  State state = model_.initial();
  const double energy = model_.energy(state);
  const auto integrator =
      make_integrator(method, model_.system(), options_for(method, least_accuracy, model_));
  const double at_once = until_ * std::sqrt(machine_epsilon);
  if (integrator->advance(state, at_once).outcome == Outcome::reached_end)
    energy_lost_at_start_ = model_.energy(state) - energy;
}

void Stage::look_within_steps(const Method& method, double value, const Limits& limits) {
  std::vector<double> steps{0};
  run_by(*integrator(model_, method, value, limits), model_, model_.initial(), method, value,
         limits, [&](const State& seen) { steps.push_back(seen.t); });
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  const auto looks = static_cast<std::size_t>(rules_.looks_at_a_path);
  const std::size_t every = 1 + steps.size() / looks, in_each = 1 + looks / steps.size();
  for (std::size_t i = every; i < steps.size(); i += every) {
    for (std::size_t k = 0; k < in_each; ++k)
      times_.push_back(steps[i - 1] + part(random) * (steps[i] - steps[i - 1]));
  }
  std::ranges::sort(times_);
}

Trial Stage::run(const Method& method, double value, const Limits& limits) const {
  const auto own = integrator(model_, method, value, limits);
  Trial trial = run_by(*own, model_, model_.initial(), method, value, limits);
  time_again(trial, *own);
  return trial;
}

Trial Stage::run_pushed(const Method& method, double value, const Limits& limits,
                        const Push& push) const {
  Trial trial = run_by(*integrator(model_, method, value, limits), model_,
                       pushed_start(model_, scales_, push), method, value, limits);
  trial.is_pushed = true;
  return trial;
}

void Stage::time_again(Trial& trial) const {
  if (is_short(trial)) time_again(trial, *integrator(model_, *trial.method, trial.value, {}));
}

bool Stage::is_short(const Trial& trial) const {
  return trial.reached_end() && trial.seconds < rules_.small * rules_.unnoticed;
}

void Stage::time_again(Trial& trial, Integrator& integrator) const {
  if (!is_short(trial)) return;
  State state = model_.initial();
  Outcome outcome = Outcome::reached_end;
  const double seconds = seconds_of([&] { outcome = integrator.advance(state, until_).outcome; });
  // Without looks it may take a few forces more, and have no more left.
  if (outcome == Outcome::reached_end) trial.seconds = std::min(trial.seconds, seconds);
}

void Stage::measure_by(const Trial& trial) {
  scales_ = {};
  extend(scales_, model_, model_.initial());
  for (const State& seen : trial.path) extend(scales_, model_, seen);
  if (drawn_) reach_to_pins(scales_, *drawn_);
  rests_ = take_extents_at_rest(scales_, rules_.rest);
}

double Stage::rounding() const {
  double largest = machine_epsilon;
  for (const PartScale& part : scales_.parts) {
    const double scale = scales_.displacement_of(part);
    if (scale > 0) largest = std::max(largest, machine_epsilon / 2 * part.extent / scale);
  }
  return largest;
}

double Stage::rounding_of_modes(double bound_of_w) const {
  // A motion computed mode by mode has w_max^2 to its last digit. So a slower frequency w has an
  // error of w_max^2 / (2 w) roundings, for a time t.
  const double slow = scales_.displacement > 0 ? scales_.speed / scales_.displacement : 0;
  const double phase = bound_of_w * until_ * (slow > 0 ? std::max(1.0, bound_of_w / slow) : 1);
  // Positions are sums of many numbers as large as coordinates.
  return rules_.rest * rounding() +
         (rests() ? 0 : rules_.doubt_of_two() * machine_epsilon * (1 + phase));
}

double Stage::least_scale() const {
  double least = scales_.displacement;
  for (const PartScale& part : scales_.parts)
    least = std::min(least, scales_.displacement_of(part));
  return least;
}

double Stage::relative(const Vec& displacements) const {
  const std::vector<double> sizes = model_.largest_by_part(displacements);
  double largest = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const bool has_own = i < scales_.parts.size();
    largest = std::max(largest, sizes[i] / (has_own ? scales_.displacement_of(scales_.parts[i])
                                                    : scales_.displacement));
  }
  return largest;
}

double Stage::energy_scale() const { return scales_.kinetic > 0 && !rests_ ? scales_.kinetic : 1; }

double Stage::energy_error(const Trial& trial) const { return trial.energy_gap / energy_scale(); }

double Stage::energy_rounding(const Trial& trial) const {
  double largest = 0;
  Shift shift({});
  for (State seen : trial.path) {
    const double energy = model_.energy(seen);
    for (double& q : seen.q) shift(q, std::abs(q));
    largest = std::max(
        {largest, std::abs(model_.energy(seen) - energy), machine_epsilon * std::abs(energy)});
  }
  return largest / energy_scale();
}

double Stage::distance(const Trial& one, const Trial& other) const {
  if (broken_springs(one) != broken_springs(other)) return std::numeric_limits<double>::infinity();
  // Between the looks the largest distance may be larger.
  if (of_ == AccuracyOf::path) return rules_.doubt * std::ranges::max(distances(one, other));
  return position_error(model_, one.path.back(), other.path.back(), scales_);
}

std::vector<double> Stage::distances(const Trial& one, const Trial& other) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < std::min(one.path.size(), other.path.size()); ++i)
    all.push_back(position_error(model_, one.path[i], other.path[i], scales_));
  return all;
}

bool Stage::is_reduced_by_symmetry() const {
  return has_springs() && std::ranges::any_of(model_.findings(), [](const Finding& finding) {
           return finding.reduction == Reduction::dimension ||
                  finding.reduction == Reduction::mirror;
         });
}

std::vector<double> Stage::distances_as_drawn(const Trial& trial, const Method& method,
                                              double value, const Limits& limits,
                                              const Push& push) const {
  std::vector<double> all;
  if (!has_springs()) return all;
  const Model drawn(pushed_scene(*drawn_, scales_, push),
                    Reductions().without(Reduction::dimension).without(Reduction::mirror));
  if (!applies_to(method, drawn.system())) return all;
  const Trial pushed = run_by(*integrator(drawn, method, value, limits), drawn, drawn.initial(),
                              method, value, limits);
  if (!pushed.reached_end()) return all;
  std::vector<Node> nodes, expected;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    drawn.expand(pushed.path[i], nodes);
    model_.expand(trial.path[i], expected);
    all.push_back(position_error(nodes, expected, scales_));
  }
  return all;
}

}  // namespace qddot::inline measure
