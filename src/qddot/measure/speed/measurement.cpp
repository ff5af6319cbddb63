#include "qddot/measure/speed/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"

namespace qddot::inline measure {
namespace {

// Runs shorter than this [s] are timed in batches. The clock's own cost (some tens of ns) then
// stays below a thousandth.
constexpr double shortest_sample = 1e-4;
// A disturbed point has so many times the timed runs of another.
constexpr int most_rounds = 3;
// A first run of at least this time [s] counts as a sample: its warm-up is a small part of it.
constexpr double own_warm_up = 0.1;
// The time limit [s] of a watched run. It is as long as the run before and is not timed.
constexpr double longest_look = 60;

bool reads_stiffness(const Method& method) {
  return method.is(Trait::implicit) || method.is(Trait::bounds_steps) ||
         method.asks(Need::stiffness) || method.asks(Need::laplacian);
}

// Measures the point.
Point taken(const Method& method, double value, const Model& scene, double until,
            const Reference& reference, const Effort& effort) {
  Point point{.method = &method, .value = value};
  const Options options = options_for(method, value, scene, effort.options);
  std::unique_ptr<Integrator> integrator;
  // K's pattern belongs to the scene. Else the first method that asks for it would pay for all.
  if (reads_stiffness(method)) scene.system().stiffness_pattern();
  point.setup = seconds_of([&] { integrator = make_integrator(method, scene.system(), options); });

  State state = scene.initial();
  const Deadline deadline(effort.seconds);
  Summary summary;
  const double first =
      seconds_of([&] { summary = integrator->advance(state, until, {}, deadline.token()); });
  point.outcome = summary.outcome;
  point.t_reached = summary.t_reached;
  point.counts = summary.counts;
  point.energy_growth = summary.energy_growth;
  if (summary.outcome != Outcome::reached_end) return point;
  point.errors = errors_between(scene, state, reference.end, reference.energy, reference.scales);

  const int batch = static_cast<int>(std::ceil(std::min(shortest_sample / first, 1e5)));
  std::vector<double> times;
  if (first >= own_warm_up) {
    times.push_back(first);
    point.time = point.time_min = first;
  }
  double spent = times.empty() ? 0 : first;
  const auto is_done = [&] {
    const auto taken = std::ssize(times);
    return taken >= effort.repeats &&
           (!is_disturbed(point) || taken >= most_rounds * effort.repeats);
  };
  while (!is_done() && (times.empty() || spent + first < effort.seconds / 2)) {
    const double sample = seconds_of([&] {
      for (int i = 0; i < batch && summary.outcome == Outcome::reached_end; ++i) {
        state = scene.initial();
        summary = integrator->advance(state, until);
      }
    });
    if (summary.outcome != Outcome::reached_end) {  // half a run gives no time
      point.outcome = summary.outcome;
      point.t_reached = summary.t_reached;
      point.errors = {};
      return point;
    }
    spent += sample;
    times.push_back(sample / batch);
    point.time = median(times);
    point.time_min = std::ranges::min(times);
  }
  point.timed_runs = static_cast<int>(times.size());
  if (effort.watch) {
    point.path = effort.watch->see(method, options, point.counts.steps,
                                   std::max(longest_look, 2 * effort.seconds));
    // The energy error at the end of the timed run counts too.
    point.path.energy = std::max(point.path.energy, point.errors.energy);
  }
  return point;
}

}  // namespace

Options options_for(const Method& method, double value, const Model& scene, Options options) {
  (method.knob == Knob::step_size ? options.step_size : options.rtol) = value;
  return with_tolerance_scales(options, scene);
}

Point measure_point(const Method& method, double value, const Model& scene, double until,
                    const Reference& reference, const Effort& effort) {
  const auto take = [&] { return taken(method, value, scene, until, reference, effort); };
  return effort.recall ? effort.recall(method, value, take) : take();
}

}  // namespace qddot::inline measure
