#include "experiments/motions/reference_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::motions {
namespace {

// A reference is seen in a picture, and distances from it on a scale of powers of ten.
constexpr double good_enough = 1e-9, least_accurate = 1e-6;
constexpr double near_to_best = 10;

double error_of(const Point& point) {
  const bool is_known = point.outcome == Outcome::reached_end && point.errors.position >= 0;
  return is_known ? point.errors.position : std::numeric_limits<double>::infinity();
}

const Point* fast_and_accurate(const std::vector<Point>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const Point& point : points) least = std::min(least, error_of(point));
  const double enough = std::max(good_enough, near_to_best * least);
  if (!(enough <= least_accurate)) return nullptr;
  const Point* best = nullptr;
  for (const Point& point : points) {
    if (error_of(point) <= enough && (!best || point.time < best->time)) best = &point;
  }
  return best;
}

double error_at_end(const std::vector<State>& states, const ReducedScene& scene,
                    const Reference& reference) {
  return errors_between(scene, states.back(), reference.end, reference.energy, reference.scales)
      .position;
}

}  // namespace

std::vector<State> states_at(const std::vector<double>& times, const ReducedScene& scene,
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
                                                const ReducedScene& scene,
                                                const Reference& reference,
                                                const std::vector<Point>& points,
                                                const Options& options, double seconds) {
  if (const Point* point = fast_and_accurate(points)) {
    auto states = states_at(times, scene, *point->method,
                            options_for(*point->method, point->value, scene, options), seconds);
    if (states.size() == times.size()) {
      const double error = error_at_end(states, scene, reference);
      if (error <= least_accurate)
        return ReferenceMotion{point->method, point->value, states, error};
    }
  }
  constexpr double fewest_steps = 100;
  const auto start = std::chrono::steady_clock::now();
  const Method& method = *find_method("kahan_li8");
  for (double steps = std::max<double>(fewest_steps, static_cast<double>(times.size() - 1));
       seconds_since(start) < seconds; steps *= 4) {
    const double h = times.back() / steps;
    auto states = states_at(times, scene, method, options_for(method, h, scene),
                            seconds - seconds_since(start));
    if (states.size() < times.size()) continue;
    const double error = error_at_end(states, scene, reference);
    if (error <= least_accurate) return ReferenceMotion{&method, h, states, error};
  }
  return {};
}

}  // namespace qddot::motions
