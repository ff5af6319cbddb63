#include "experiments/motions/reference_motion.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference_ways.hpp"

namespace qddot::motions {
namespace {

constexpr double least_accurate = 1e-6;
// Steps of the composition: so many at the least, and so many times as many again and again.
constexpr double fewest_steps = 100, refinement = 2, most_steps = 1e8;

double error_of(const Point& point) {
  const bool is_known = point.outcome == Outcome::reached_end && point.errors.position >= 0;
  return is_known ? point.errors.position : std::numeric_limits<double>::infinity();
}

const Point* most_accurate(const std::vector<Point>& points) {
  const auto best = std::ranges::min_element(points, {}, error_of);
  return best == points.end() || !(error_of(*best) <= least_accurate) ? nullptr : &*best;
}

double error_at_end(const std::vector<State>& states, const Model& scene,
                    const Reference& reference) {
  return errors_between(scene, states.back(), reference.end, reference.energy, reference.scales)
      .position;
}

}  // namespace

std::vector<State> states_at(const std::vector<double>& times, const Model& scene,
                             const Method& method, const Options& options, double seconds) {
  State state = scene.initial();
  std::vector<State> states = {state};
  const Observer each{{times.begin() + 1, times.end()},
                      [&](const State& seen) { states.push_back(seen); }};
  const auto integrator = make_integrator(method, scene.system(), options);
  const Deadline deadline(seconds);
  integrator->advance(state, times.back(), each, deadline.token());
  stop_if_interrupted();
  return states;
}

std::optional<ReferenceMotion> reference_motion(const std::vector<double>& times,
                                                const Model& scene, const Reference& reference,
                                                const std::vector<Point>& points,
                                                const Options& options, double seconds) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<ReferenceMotion> best;
  // Whether the run is the best so far; it is none where it does not come to the end in time.
  const auto improves = [&](const Method& method, double value, const Options& own) {
    const double left = seconds - seconds_since(start);
    if (!(left > 0)) return false;
    auto states = states_at(times, scene, method, options_for(method, value, scene, own), left);
    if (states.size() < times.size()) return false;
    const double error = error_at_end(states, scene, reference);
    if (!(error < (best ? best->error : least_accurate))) return false;
    best = {&method, value, std::move(states), error};
    return true;
  };
  const Method& composition = resolving_method(scene.system());
  for (double steps = std::max(fewest_steps, static_cast<double>(times.size() - 1));
       steps <= most_steps && seconds_since(start) < seconds; steps *= refinement) {
    // Below what is certified nothing can be told; where an error grows again, rounding has it.
    const bool is_better = improves(composition, times.back() / steps, {});
    if (best && (!is_better || best->error <= reference.certified.position)) break;
  }
  const Point* point = most_accurate(points);
  if (point && (!best || error_of(*point) < best->error)) {
    improves(*point->method, point->value, options);
  }
  return best;
}

}  // namespace qddot::motions
