#include "qddot/measure/advice/trial.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference_rounding.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// Runs shorter than this [s] are timed again, as the first one runs with cold caches.
constexpr double short_run = 1e-3;
constexpr int repeats_of_short = 3;

}  // namespace

Stage::Stage(const ReducedScene& model, double until, AccuracyOf of, int looks)
    : model_(model), until_(until), of_(of) {
  for (int i = 1; i < looks; ++i) times_.push_back(until * i / looks);
  times_.push_back(until);
}

Trial Stage::run_from(const State& start, const Method& method, double value,
                      double seconds) const {
  Trial trial{.method = &method, .value = value};
  const auto integrator =
      make_integrator(method, model_.system(), options_for(method, value, model_));
  State state = start;
  const Deadline deadline(seconds);
  const bool only_the_end =
      of_ == AccuracyOf::positions && method.is(Trait::implicit) && method.knob == Knob::step_size;
  const Observer each{only_the_end ? std::vector{until_} : times_,
                      [&](const State& seen) { trial.path.push_back(seen); }};
  trial.seconds = seconds_of(
      [&] { trial.summary = integrator->advance(state, until_, each, deadline.token()); });
  if (!trial.reached_end()) stop_if_interrupted();
  return trial;
}

Trial Stage::run(const Method& method, double value, double seconds) const {
  Trial trial = run_from(model_.initial(), method, value, seconds);
  if (of_ == AccuracyOf::energy) {
    const double energy = model_.energy(model_.initial());
    for (const State& seen : trial.path)
      trial.energy_gap = std::max(trial.energy_gap, std::abs(model_.energy(seen) - energy));
  }
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
}

double Stage::energy_error(const Trial& trial) const {
  return scales_.kinetic > 0 ? trial.energy_gap / scales_.kinetic : trial.energy_gap;
}

double Stage::distance(const Trial& one, const Trial& other) const {
  if (of_ == AccuracyOf::path) return std::ranges::max(distances(one, other));
  return errors_between(model_, one.path.back(), other.path.back(), 0, scales_).position;
}

std::vector<double> Stage::distances(const Trial& one, const Trial& other) const {
  std::vector<double> all;
  if (one.path.size() != other.path.size() || one.path.size() != times_.size()) return all;
  for (std::size_t i = 0; i < times_.size(); ++i)
    all.push_back(errors_between(model_, one.path[i], other.path[i], 0, scales_).position);
  return all;
}

std::optional<Divergence> parting_of_twins(const Stage& stage, const Trial& trial, double seconds) {
  const State pushed = displaced_start(stage.model(), stage.scales(), machine_epsilon);
  const Trial twin = stage.run_from(pushed, *trial.method, trial.value, seconds);
  if (!twin.reached_end()) return {};
  const std::vector<double> seen = stage.distances(trial, twin);
  if (seen.empty()) return {};
  std::vector<double> times{0}, distances{machine_epsilon};
  times.insert(times.end(), stage.times().begin(), stage.times().end());
  distances.insert(distances.end(), seen.begin(), seen.end());
  return divergence(times, distances);
}

}  // namespace qddot::inline measure
