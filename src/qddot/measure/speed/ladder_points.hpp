#pragma once

#include <functional>
#include <vector>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline measure {

// Measures one method over the values of its knob, from coarse to fine.
// The coarsest points fail or have an error as large as the motion. The finest point is the first
// one for which one of these holds, where errors are those that decide accuracy (judgement.hpp):
// - its error is at most the certified error of the reference,
// - rounding keeps its error from falling,
// - its run takes longer than the effort allows (its outcome is over_budget),
// - it reached the end and `is_last` holds.
// Luck does not end it: for the first and the last, the run before must be as good, or errors must
// have fallen as the order says (see judged_together).
// The expected error falls by a factor of four from point to point (step sizes: h by 4^(1/order)),
// or by ten (tolerances). Fixed steps are denser near the stability limit of the whole run (see
// ladder.hpp), for explicit methods and for implicit ones that blew up. `report` is called with
// each point.
std::vector<Point> measure_ladder(const Method& method, const Model& scene, double until,
                                  const Reference& reference, const Effort& effort,
                                  const std::function<void(const Point&)>& report,
                                  const std::function<bool(const Point&)>& is_last = {});

}  // namespace qddot::inline measure
