#pragma once

#include <functional>
#include <vector>

#include "qddot/measure/speed/chart.hpp"

namespace qddot::inline measure {

// Speed against accuracy: the times and errors of every method, from coarse to fine.
struct WorkPrecision {
  Reference reference;        // what errors are measured against
  std::vector<Point> points;  // of each method over its knob's values (see measure_ladder)

  // The fastest point at each accuracy 1e-1 ... 1e-9; rows point into `points`.
  std::vector<FrontRow> front() const { return fastest_at_each_accuracy(points, reference); }
  // All that is said of the points, with stability margins on the model. Borrows the points.
  Chart chart(const Model& model) const {
    return chart_of(points, reference, usual_accuracies(), StabilityMargins(model));
  }
};

// Measures the methods on the model up to the time `until` [s], against a reference that takes
// about `reference_seconds`. Without `methods` it measures all that can run the model. `report` is
// called with each point. The points that decide are timed again at the end (time_front_again).
// Throws NoReference if no reference can be made. Throws std::invalid_argument for a model with
// massless unknowns or without unknowns, and for a method that cannot run it.
WorkPrecision work_precision(const Model& model, double until,
                             std::vector<const Method*> methods = {}, const Effort& effort = {},
                             double reference_seconds = 10,
                             const std::function<void(const Point&)>& report = {});
// The same up to the end of a given reference.
WorkPrecision work_precision(const Model& model, Reference reference,
                             std::vector<const Method*> methods = {}, const Effort& effort = {},
                             const std::function<void(const Point&)>& report = {});

}  // namespace qddot::inline measure
