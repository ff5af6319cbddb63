#pragma once

#include <functional>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/watch.hpp"

namespace qddot::inline measure {

// One point of the work-precision chart: a method at one value of its knob.
struct Point {
  const Method* method = nullptr;
  double value = 0;      // of the knob: h [s] or rtol
  Outcome outcome{};     // errors and times below mean something only where it is reached_end
  double t_reached = 0;  // [s]
  Errors errors{};
  PathErrors path{};
  double time = 0, time_min = 0;  // median and least time of a run [s], set-up left out
  double setup = 0;               // time of allocation and symbolic analysis [s]
  int timed_runs = 0;
  Counts counts{};
  double energy_growth = 1;  // as in Summary
};

// Limits and settings of the measurement of a point.
struct Effort {
  using Take = std::function<Point()>;

  double seconds = 10;  // for one run; slower ones become over_budget
  // Timed runs; fewer, but at least one, if these would take more than half of `seconds`.
  int repeats = 5;
  Options options{};             // beside the knob
  const Watch* watch = nullptr;  // if any, sees one more run, untimed
  // If set, returns a point that is already known, else calls `take`.
  std::function<Point(const Method&, double value, const Take& take)> recall{};
};

// The options with the method's knob at `value` and the scene's tolerance scales.
Options options_for(const Method& method, double value, const Model& scene, Options options = {});

// Whether the times of the point's runs vary: the median is more than a quarter above the least, as
// where other programs run beside it.
inline bool is_disturbed(const Point& point) {
  return point.time_min > 0 && point.time > 1.25 * point.time_min;
}

// Returns the point as Effort::recall has it, or measures it: runs the method once untimed, and
// then up to `repeats` times, or up to three times as often if it is disturbed. A first run of 0.1
// s or more counts as timed. A repeat that fails makes the point a failure. Runs too short for the
// clock are timed in batches. Single thread. Times are those of the clock in use.
Point measure_point(const Method& method, double value, const Model& scene, double until,
                    const Reference& reference, const Effort& effort);

}  // namespace qddot::inline measure
