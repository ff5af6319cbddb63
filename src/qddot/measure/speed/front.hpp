#pragma once

#include <limits>
#include <string>
#include <vector>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline measure {

// The fastest points at one accuracy, of all methods and of each family; nullptr if there is none.
// The error of a point is known to be at most the accuracy if the measured error (see
// judgement.hpp) and the certified error of the reference together are.
struct FrontRow {
  double accuracy = 0;
  bool may_be_reached = false;  // by a point whose error is uncertain
  const Point* fastest = nullptr;
  const Point* fastest_hand_written = nullptr;
  const Point* fastest_sundials = nullptr;
  // The distance of the fastest point's step to its stability limit: 1 - h / (limit / w_max), w_max
  // at the start. It is for explicit methods of fixed steps, and NaN for others. Motion may raise
  // w_max, so that a longer run blows up if the margin is small.
  double stability_margin = std::numeric_limits<double>::quiet_NaN();
};

// Replaces `fastest`, which may be nullptr, by `point` if `point` takes less time.
void keep_faster(const Point*& fastest, const Point& point);

// 1e-1, 1e-2, ... 1e-9.
const std::vector<double>& usual_accuracies();

// The front: one row for each accuracy, with pointers into `points`.
std::vector<FrontRow> fastest_at_each_accuracy(
    const std::vector<Point>& points, const Reference& reference,
    const std::vector<double>& accuracies = usual_accuracies());

// The fastest point of each method with an error that is known to be at most the accuracy; the
// fastest method first. Pointers into `points`.
std::vector<const Point*> fastest_of_each_method(const std::vector<Point>& points,
                                                 const Reference& reference, double accuracy);

// Computes the stability margins of the rows, from the largest frequency of the scene.
void add_stability_margins(std::vector<FrontRow>& rows, const ReducedScene& scene);

}  // namespace qddot::inline measure
