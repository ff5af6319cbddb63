#pragma once

#include <vector>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {

// The fastest run of any method to an accuracy, found by trying them all.
struct Hindsight {
  std::vector<Point> points;  // all that were taken
  Point best;                 // not reached_end where no run came so far
};

// Finds the fastest run that is known to be within `accuracy` of the reference. It tries all
// methods that fit the scene and may be the fastest, the most promising ones first, for half a
// minute in all. A ladder ends when its runs take longer than the fastest run so far. The best few
// runs are timed `repeats` times.
Hindsight hindsight(const ReducedScene& scene, double until, double accuracy,
                    const Reference& reference, int repeats);

}  // namespace qddot::judged_advice
