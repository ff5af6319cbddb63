#include "qddot/measure/advice/trial.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference_rounding.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// Runs shorter than this [s] are timed again, as the first one runs with cold caches.
constexpr double short_run = 1e-3;
constexpr int repeats_of_short = 3;
// A part that moves by no more roundings of its positions than this has no motion to measure.
constexpr double roundings_at_rest = 30;
// The largest relative rounding error of a number.
constexpr double one_rounding = machine_epsilon / 2;

}  // namespace

Stage::Stage(const ReducedScene& model, double until, AccuracyOf of, int looks, const Scene* drawn)
    : model_(model), until_(until), of_(of), drawn_(drawn), times_(random_times(until, looks)) {}

Trial Stage::run_from(const ReducedScene& model, const State& start, const Method& method,
                      double value, const Limits& limits) const {
  Trial trial{.method = &method, .value = value};
  Options options = options_for(method, value, model);
  options.most_forces = limits.forces;
  const auto integrator = make_integrator(method, model.system(), options);
  State state = start;
  const Deadline deadline(limits.seconds);
  const double energy = model.energy(start);
  const auto see_energy = [&](const State& seen) {
    const double gain = model.energy(seen) - energy;
    trial.energy_gain = std::max(trial.energy_gain, gain);
    trial.energy_gap = std::max(trial.energy_gap, std::abs(gain));
  };
  Observer each{times_, [&](const State& seen) { trial.path.push_back(seen); }};
  if (of_ == AccuracyOf::energy) each.step = see_energy;
  trial.seconds = seconds_of(
      [&] { trial.summary = integrator->advance(state, until_, each, deadline.token()); });
  for (const State& seen : trial.path) see_energy(seen);
  if (!trial.reached_end()) stop_if_interrupted();
  return trial;
}

Trial Stage::run(const Method& method, double value, const Limits& limits) const {
  return run_from(model_, model_.initial(), method, value, limits);
}

Trial Stage::run_pushed(const Method& method, double value, const Limits& limits) const {
  Trial trial =
      run_from(model_, displaced_start(model_, scales_, one_rounding), method, value, limits);
  trial.is_pushed = true;
  return trial;
}

void Stage::time_again(Trial& trial) const {
  if (!trial.reached_end() || trial.seconds >= short_run) return;
  const auto integrator = make_integrator(*trial.method, model_.system(),
                                          options_for(*trial.method, trial.value, model_));
  for (int i = 0; i < repeats_of_short; ++i) {
    State state = model_.initial();
    trial.seconds =
        std::min(trial.seconds, seconds_of([&] { integrator->advance(state, until_); }));
  }
}

void Stage::measure_by(const Trial& trial) {
  scales_ = {};
  extend(scales_, model_, model_.initial());
  for (const State& seen : trial.path) extend(scales_, model_, seen);
  if (!rests()) return;
  // Errors of what rests are relative to its size.
  for (PartScale& part : scales_.parts) {
    part.displacement = part.extent;
    scales_.displacement = std::max(scales_.displacement, part.extent);
  }
}

double Stage::rounding() const {
  double largest = machine_epsilon;
  for (const PartScale& part : scales_.parts) {
    const double scale = scales_.displacement_of(part);
    if (scale > 0) largest = std::max(largest, one_rounding * part.extent / scale);
  }
  return largest;
}

bool Stage::rests() const {
  return std::ranges::all_of(scales_.parts, [](const PartScale& part) {
    return part.displacement <= roundings_at_rest * machine_epsilon * part.extent;
  });
}

double Stage::energy_error(const Trial& trial) const {
  return scales_.kinetic > 0 ? trial.energy_gap / scales_.kinetic : trial.energy_gap;
}

double Stage::energy_rounding(const Trial& trial) const {
  if (!(scales_.kinetic > 0)) return 0;
  Vec f(model_.system().size());
  double largest = 0;
  for (const State& seen : trial.path) {
    model_.system().force(seen.q, f);
    largest = std::max(largest, f.cwiseAbs().dot(seen.q.cwiseAbs()));
  }
  return one_rounding * largest / scales_.kinetic;
}

double Stage::distance(const Trial& one, const Trial& other) const {
  // Between the looks the largest distance may be larger.
  constexpr double between = 1.4;
  if (of_ == AccuracyOf::path) return between * std::ranges::max(distances(one, other));
  return errors_between(model_, one.path.back(), other.path.back(), 0, scales_).position;
}

std::vector<double> Stage::distances(const Trial& one, const Trial& other) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < std::min(one.path.size(), other.path.size()); ++i)
    all.push_back(errors_between(model_, one.path[i], other.path[i], 0, scales_).position);
  return all;
}

bool Stage::is_reduced_by_symmetry() const {
  return drawn_ && std::ranges::any_of(model_.findings(), [](const Finding& finding) {
           return finding.reduction == Reduction::dimension ||
                  finding.reduction == Reduction::mirror;
         });
}

std::vector<double> Stage::distances_out_of_symmetry(const Trial& trial,
                                                     const Limits& limits) const {
  const ReducedScene drawn(*drawn_,
                           Reductions().without(Reduction::dimension).without(Reduction::mirror));
  Scales scales;
  extend(scales, drawn, drawn.initial());
  // A node that starts at the origin has no coordinate to round; its displacement is rounded
  // instead.
  for (PartScale& part : scales.parts) {
    if (part.extent == 0) part.displacement = scales_.displacement;
  }
  const State start = displaced_start(drawn, scales, one_rounding);
  const Trial pushed = run_from(drawn, start, *trial.method, trial.value, limits);
  std::vector<double> all;
  if (!pushed.reached_end()) return all;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    all.push_back(
        position_error(drawn.expand(pushed.path[i]), model_.expand(trial.path[i]), scales_));
  }
  return all;
}

}  // namespace qddot::inline measure
