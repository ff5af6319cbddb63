#pragma once

#include <functional>
#include <vector>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::measure {

// Measures one method over the values of its knob: up to where it fails or is a whole motion off,
// down to the certified floor of the reference, to where rounding stops it (both of the error that
// runs are judged by, see judgement.hpp), or to where a run takes longer than the effort allows
// (that row is over_budget). Neighbouring points divide the expected error by four (step sizes: h
// by 4^(1/order)) or by ten (tolerances). Steps of a fixed size, of explicit methods and of
// implicit ones that ran away, are taken closer near the limit of their stability, which is the one
// of the whole run (see ladder.hpp). Points from coarse to fine; `report` sees each as it comes. No
// finer point is taken after one that reached the end and `is_last`.
std::vector<Point> sweep(const Method& method, const ReducedScene& scene, double until,
                         const Reference& reference, const Effort& effort,
                         const std::function<void(const Point&)>& report,
                         const std::function<bool(const Point&)>& is_last = {});

}  // namespace qddot::measure
