#include "experiments/stability_map/run_outcome.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stop_token>
#include <vector>

#include "qddot/algebra/straight_line.hpp"
#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/error.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"

namespace qddot::stability_map {
namespace {

// Chosen values, stated in run_outcome.hpp; verdicts depend on them if a run is at the limit of its
// method.

// X is recorded after this many steps at first, and this many times later.
constexpr int watched_steps = 200, samples_more = 400;
// A growth of fewer samples is fitted from its beginning.
constexpr std::ptrdiff_t few = 8;
// h times the rate of the sideways push from which M - h^2 K is nearly singular; it is singular at
// 1.
constexpr double nearly_singular = 0.9;
// The ratios X over X(0) from which a run may be diverging, is growing, and is unbounded.
constexpr double suspicious = 10, growing = 3, unbounded = 1e6;
// A run's iterations are checked by a run with this many times as many. It may change the motion by
// at most this part of its size.
constexpr int more_iterations = 5;
constexpr double other_motion = 0.1;

struct Sample {
  double t, ratio;  // X over X(0)
};

// Every step at first, for fast growth, then random ones; all are multiples of h, so that no step
// is changed.
std::vector<double> looks(const Options& options, double until) {
  std::vector<double> times;
  const double h =
      options.step_size > 0 ? options.step_size : until / (watched_steps + samples_more);
  // A run of most_steps can't be taken.
  const double steps = std::clamp(std::round(until / h), 1.0, most_steps / 2);
  const double watched = std::min<double>(steps, watched_steps);
  for (double n = 1; n <= watched; ++n) times.push_back(n * h);
  for (const double n : random_step_times(1, steps, samples_more)) {
    if (n > watched) times.push_back(n * h);
  }
  return times;
}

struct Run {
  Summary summary;
  std::vector<Sample> samples;
  State end;
  bool was_stopped = false;  // as X grew beyond all bounds
  // Set if X jumped beyond `suspicious`: h times the rate [1/s] of the sideways push at the state
  // before. Only for linearly implicit methods.
  std::optional<double> pushed{};
};

Run run(const Method& method, const Options& options, const Model& scene, double until,
        const RunPlan& plan) {
  Run result{.summary = {}, .samples = {}, .end = scene.initial()};
  const double start = scene.energy(result.end) - plan.rest_energy;
  const Deadline deadline(plan.seconds);
  std::stop_source stop;
  const std::stop_callback pass_on(deadline.token(), [&] { stop.request_stop(); });
  Vec before = result.end.q;
  const auto see = [&](const State& state) {
    const double ratio = (scene.energy(state) - plan.rest_energy) / start;
    if (method.is(Trait::linearly_implicit) && !result.pushed && !(ratio < suspicious)) {
      result.pushed = options.step_size * buckling_rate(scene.system(), before);
    }
    if (method.is(Trait::linearly_implicit)) before = state.q;
    if (std::isfinite(ratio)) result.samples.push_back({state.t, ratio});
    if (!(ratio < unbounded)) {
      result.was_stopped = true;
      stop.request_stop();
    }
  };
  result.samples.push_back({0, 1});
  const std::vector<double> times = looks(options, until);
  result.summary = make_integrator(method, scene.system(), with_tolerance_scales(options, scene))
                       ->advance(result.end, times.back(), {times, see}, stop.get_token());
  return result;
}

using Samples = std::vector<Sample>;

double mean(Samples::const_iterator first, Samples::const_iterator last) {
  return std::accumulate(first, last, 0.0,
                         [](double sum, const Sample& s) { return sum + s.ratio; }) /
         static_cast<double>(last - first);
}

double largest(Samples::const_iterator first, Samples::const_iterator last) {
  return std::ranges::max_element(first, last, {}, &Sample::ratio)->ratio;
}

// The samples from `part` of the run's time on; at least the last one.
Samples::const_iterator from(const Samples& samples, double part) {
  const double t = part * samples.back().t;
  return std::ranges::lower_bound(samples, t, {}, &Sample::t);
}

// The slope of the straight line nearest to (t, 1/2 ln X).
double slope(Samples::const_iterator first, Samples::const_iterator last) {
  std::vector<double> t, x;
  for (auto s = first; s != last; ++s) {
    if (s->ratio <= 0) continue;
    t.push_back(s->t);
    x.push_back(std::log(s->ratio) / 2);
  }
  return straight_line(t, x).slope;
}

double growth_rate(const Samples& samples) {
  auto first = samples.end();
  while (first != samples.begin() && std::prev(first)->ratio > growing) --first;
  const auto grown = samples.end() - first;
  if (grown < 2) return slope(from(samples, 0.5), samples.end());
  return slope(grown < few ? std::prev(first) : first + grown / 2, samples.end());
}

std::string judged(const Run& r, const RunOutcome& result, double tolerated) {
  if (r.pushed > nearly_singular) return std::string(name(Outcome::indefinite_matrix));
  if (r.was_stopped) return "diverged";
  const Outcome outcome = r.summary.outcome;
  if (outcome != Outcome::reached_end) return std::string(name(outcome));
  const auto half = from(r.samples, 0.5);
  const double before = largest(r.samples.begin(), std::next(half)),
               after = largest(half, r.samples.end());
  if (after > suspicious && after > growing * before) return "diverged";
  const double early = mean(r.samples.begin(), std::next(from(r.samples, 0.25)));
  if (result.energy_end > (1 + tolerated) * std::max(1.0, early)) return "gained";
  if (result.energy_end < 1 - tolerated) return "leaked";
  return "bounded";
}

// The largest distance between a node's places in two states, over the largest displacement in the
// motion.
double difference(const Model& scene, const State& a, const State& b) {
  Scales scales;
  extend(scales, scene, a);
  extend(scales, scene, b);
  return errors_between(scene, a, b, 0, scales).position;
}

}  // namespace

RunOutcome run_outcome(const Method& method, const Options& options, const Model& scene,
                       const RunPlan& plan) {
  const double until = std::max(plan.until, least_steps * options.step_size);
  const Run r = run(method, options, scene, until, plan);
  RunOutcome result{.outcome = "",
                    .growth_rate = growth_rate(r.samples),
                    .t_reached = r.summary.t_reached,
                    .energy_end = mean(from(r.samples, 0.75), r.samples.end()),
                    .energy_max = largest(r.samples.begin(), r.samples.end()),
                    .mean_step = r.summary.t_reached / static_cast<double>(std::max<std::int64_t>(
                                                           1, r.summary.counts.steps)),
                    .counts = r.summary.counts};
  result.outcome = judged(r, result, plan.tolerated);
  if (method.listens_to(Option::iterations) && r.summary.outcome == Outcome::reached_end) {
    Options to_the_end = options;
    to_the_end.iterations = more_iterations * std::max(10, options.iterations);
    const Run further = run(method, to_the_end, scene, until, plan);
    if (further.summary.outcome == Outcome::reached_end &&
        difference(scene, r.end, further.end) > other_motion) {
      result.outcome = "unconverged";
    }
  }
  return result;
}

}  // namespace qddot::stability_map
