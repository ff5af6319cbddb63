#include "experiments/advice/hindsight.hpp"

#include <algorithm>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/measure/speed/ladder_points.hpp"

namespace qddot::judged_advice {
namespace {

// A run, and all runs of a case together [s].
constexpr double longest_run = 2, patience = 25;
// Runs so much slower than the fastest in one timing may be as fast in several.
constexpr double close_race = 1.3;

// The methods in the order in which they are likely to be fast: what comes first bounds the time of
// the others.
std::vector<const Method*> in_order_of_promise(const System& system) {
  std::vector<const Method*> order;
  for (const char* first : {"exact", "symmetric6", "symmetric4", "symmetric8", "verlet",
                            "symmetric10", "dprkn8", "dprkn12"}) {
    order.push_back(find_method(first));
  }
  for (const Method& method : methods()) {
    if (std::ranges::find(order, &method) == order.end()) order.push_back(&method);
  }
  // Those of order 1, the stock twins, and SUNDIALS' explicit methods, which each take several
  // times what others do on all charts, never bound anything.
  std::erase_if(order, [&](const Method* method) {
    return !applies_to(*method, system) || method->order == 1 || !method->stock_of.empty() ||
           method->name.starts_with("arkode_erk") || method->name.starts_with("arkode_mri") ||
           method->name == "cvode_adams";
  });
  return order;
}

}  // namespace

Hindsight hindsight(const ReducedScene& scene, double until, double accuracy,
                    const Reference& reference, int repeats) {
  Hindsight found;
  found.best.outcome = Outcome::over_budget;
  Effort effort{.seconds = longest_run, .repeats = 1};
  const auto is_enough = [&](const Point& point) {
    return judged(point, reference).is_within(accuracy);
  };
  const auto begin = std::chrono::steady_clock::now();
  for (const Method* method : in_order_of_promise(scene.system())) {
    if (seconds_since(begin) > patience) break;
    const auto see = [&](const Point& point) {
      found.points.push_back(point);
      if (point.outcome != Outcome::reached_end || !is_enough(point)) return;
      if (found.best.outcome == Outcome::reached_end && point.time_min >= found.best.time_min)
        return;
      found.best = point;
      effort.seconds = std::min(effort.seconds, close_race * point.time_min + 1e-4);
    };
    measure_ladder(*method, scene, until, reference, effort, see, is_enough);
  }
  std::vector<Point> near;
  for (const Point& point : found.points) {
    if (point.outcome == Outcome::reached_end && is_enough(point) &&
        point.time_min <= close_race * found.best.time_min)
      near.push_back(point);
  }
  effort = {.seconds = 4 * longest_run, .repeats = repeats};
  for (const Point& point : near) {
    const Point timed = measure_point(*point.method, point.value, scene, until, reference, effort);
    if (timed.outcome == Outcome::reached_end &&
        (timed.time_min <= found.best.time_min || found.best.timed_runs < repeats))
      found.best = timed;
  }
  return found;
}

}  // namespace qddot::judged_advice
