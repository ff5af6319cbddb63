#include "qddot/measure/trend/drift_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/trend/sample_steps.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// A run shorter than this part of its time has no verdict, unless it blew up or lost this much of
// its energy.
constexpr double least_part = 0.5, gone = 0.9;
// The numbers of samples that tables and pictures keep: in each octave, and at equal distances.
constexpr int path_octave = 24, path_even = 256;

// Records the invariants of a run's states.
class Recorder {
 public:
  Recorder(const Model& scene, const Momenta& momenta, const MotionScales& scales,
           const std::vector<SampledStep>& steps, double h)
      : scene_(scene), momenta_(momenta), scales_(scales), steps_(steps), h_(h) {
    const auto nodes = scene.expand(scene.initial());
    linear_ = momenta.linear(nodes, 0);
    angular_ = momenta.angular(nodes);
    linear_samples_.resize(static_cast<std::size_t>(linear_.size()));
    angular_samples_.resize(static_cast<std::size_t>(angular_.size()));
    energies_.reserve(steps.size());
  }

  Observer observer() {
    Observer observer{{}, [this](const State& state) { see(state, steps_[seen_++].weight); }};
    for (const SampledStep& s : steps_) {
      observer.times.push_back(static_cast<double>(s.step) * h_);
    }
    return observer;
  }

  // Adds the end of the run if it is after the last sample.
  void see_end(const State& state) {
    if (energies_.empty() ? state.t > 0 : state.t > energies_.back().t) see(state, 1);
  }

  const std::vector<Sample>& energies() const { return energies_; }
  std::optional<Trend> linear(const TrendScales& scales) const {
    return worst(linear_samples_, scales);
  }
  std::optional<Trend> angular(const TrendScales& scales) const {
    return worst(angular_samples_, scales);
  }

 private:
  void see(const State& state, double weight) {
    const double error = (scene_.energy(state) - scales_.energy) / scales_.kinetic;
    if (!std::isfinite(error)) return;
    energies_.push_back({state.t, error, weight});
    if (!momenta_.any_kept()) return;
    const auto nodes = scene_.expand(state);
    const auto take = [&](std::vector<std::vector<Sample>>& samples, const Vec& now,
                          const Vec& start, double scale) {
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto k = static_cast<Index>(i);
        samples[i].push_back({state.t, (now[k] - start[k]) / scale, weight});
      }
    };
    take(linear_samples_, momenta_.linear(nodes, state.t), linear_, scales_.linear);
    take(angular_samples_, momenta_.angular(nodes), angular_, scales_.angular);
  }

  static std::optional<Trend> worst(const std::vector<std::vector<Sample>>& components,
                                    const TrendScales& scales) {
    std::optional<Trend> worst;
    for (const auto& samples : components) {
      const Trend trend = line_of(samples, scales);
      if (!worst || std::abs(trend.last_error) > std::abs(worst->last_error)) worst = trend;
    }
    return worst;
  }

  const Model& scene_;
  const Momenta& momenta_;
  const MotionScales& scales_;
  const std::vector<SampledStep>& steps_;
  double h_;
  std::size_t seen_ = 0;
  Vec linear_, angular_;  // at t = 0
  std::vector<Sample> energies_;
  std::vector<std::vector<Sample>> linear_samples_, angular_samples_;  // by component
};

std::vector<DriftPoint> path_of(const std::vector<Sample>& samples, const MotionScales& scales) {
  std::vector<DriftPoint> path = {{0, scales.energy, 0}};
  if (samples.empty()) return path;
  const double end = samples.back().t;
  double octave_place = -INFINITY, even_place = -INFINITY;
  for (const Sample& s : samples) {
    const double octaves = std::floor(path_octave * std::log2(s.t / end));
    const double even = std::floor(path_even * s.t / end);
    if (octaves == octave_place && even == even_place) continue;
    octave_place = octaves;
    even_place = even;
    path.push_back({s.t, scales.energy + s.error * scales.kinetic, s.error});
  }
  return path;
}

}  // namespace

DriftRun run_drift(const Method& method, const Options& options, const Model& scene,
                   const Momenta& momenta, const MotionScales& scales, const DriftPlan& plan) {
  DriftRun run{.method = &method,
               .value = method.knob == Knob::step_size ? options.step_size : options.rtol};
  const auto count = static_cast<std::int64_t>(plan.until / plan.step_size * (1 + 1e-12));
  const bool lands = method.knob == Knob::rtol && !method.is(Trait::interpolates);
  const auto steps = sample_steps(count, lands ? few_cells : many_cells);
  Recorder recorder(scene, momenta, scales, steps, plan.step_size);
  Observer observer = recorder.observer();
  // A last sample that rounding puts after the end is moved to the end.
  for (double& t : observer.times) t = std::min(t, plan.until);

  State state = scene.initial();
  run.seconds = seconds_of([&] {
    const Deadline deadline(plan.seconds);
    run.summary = make_integrator(method, scene.system(), options)
                      ->advance(state, plan.until, observer, deadline.token());
  });
  recorder.see_end(state);
  const double taken = static_cast<double>(std::max<std::int64_t>(run.summary.counts.steps, 1));
  run.scales = {scales.excess, scales.frequency, scales.rounding, state.t / taken};
  run.energy = trend_of(recorder.energies(), run.summary.outcome, run.scales);
  const TrendScales of_momenta{.rounding = machine_epsilon, .step = run.scales.step};
  run.linear = recorder.linear(of_momenta);
  run.angular = recorder.angular(of_momenta);
  run.path = path_of(recorder.energies(), scales);
  return run;
}

Verdict verdict_at(const DriftRun& run, double until) {
  const Verdict verdict = run.energy.verdict;
  const bool is_seen =
      run.summary.outcome == Outcome::reached_end || run.summary.t_reached >= least_part * until;
  const bool is_over =
      verdict == Verdict::blows_up ||
      (verdict == Verdict::dissipates && -run.energy.last_error > gone * run.scales.excess);
  return is_seen || is_over ? verdict : Verdict::unknown;
}

std::string verdict(const DriftRun& run, double until) {
  const Outcome outcome = run.summary.outcome;
  const double t = run.summary.t_reached;
  std::string words = trend_in_words(run.energy, run.scales);
  if (outcome == Outcome::reached_end || run.energy.verdict == Verdict::blows_up) return words;
  const std::string part = fmt::format("{:.2g} % of the run", 100 * t / until);
  if (verdict_at(run, until) == Verdict::unknown) {
    return fmt::format("too short to tell from {}, {}; over that: {}", part,
                       outcome == Outcome::over_budget
                           ? "when its time was up"
                           : fmt::format("where it ended: {} at t = {:.4g} s", name(outcome), t),
                       words);
  }
  if (outcome == Outcome::over_budget) {
    return fmt::format("{}; over {}, when its time was up", words, part);
  }
  return fmt::format("{} at t = {:.4g} s; until then: {}", name(outcome), t, words);
}

DriftRun energy_trend(const Scene& scene, const Method& method, const Options& options,
                      double until, double seconds) {
  return energy_trend(std::make_shared<const Model>(reduced_for(method, scene)), Momenta(scene),
                      method, options, until, seconds);
}

DriftRun energy_trend(std::shared_ptr<const Model> model, const Momenta& momenta,
                      const Method& method, const Options& options, double until, double seconds) {
  constexpr double looks = 1e5;
  require_constant_energy(model->system());
  const Simulation run(std::move(model), method, options);
  const double step = options.step_size > 0 ? options.step_size : until / looks;
  return run_drift(method, run.options(), run.model(), momenta,
                   motion_scales(run.model(), momenta, until), {step, until, seconds});
}

}  // namespace qddot::inline measure
