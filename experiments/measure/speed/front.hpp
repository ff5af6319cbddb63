#pragma once

#include <limits>
#include <string>
#include <vector>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::measure {

// The answer at one accuracy: the fastest point whose error (see judgement.hpp) is known to be at
// most that, whatever the reference's own error is: the measured one and what is certified
// together; and the fastest of each family. nullptr where there is none.
struct FrontRow {
  double accuracy = 0;
  bool may_be_reached = false;  // by a point of which it is not known
  const Point* fastest = nullptr;
  const Point* fastest_hand_written = nullptr;
  const Point* fastest_sundials = nullptr;
  // How far the fastest's step stays below the limit of an explicit method of fixed steps,
  // 1 - h / (limit / w_max), w_max at the start; no number for other methods. Motion may raise
  // w_max, so that a longer run blows up where little is left.
  double stability_margin = std::numeric_limits<double>::quiet_NaN();
};

// Replaces `fastest`, which may be nullptr, by `point` if that one takes less time.
void keep_faster(const Point*& fastest, const Point& point);

// 1e-1, 1e-2, ... 1e-9.
const std::vector<double>& usual_accuracies();

// A row for each accuracy; pointers into `points`.
std::vector<FrontRow> fastest_at_each_accuracy(
    const std::vector<Point>& points, const Reference& reference,
    const std::vector<double>& accuracies = usual_accuracies());

// The fastest point of each method whose error is known to be at most the accuracy, the fastest
// first; pointers into `points`.
std::vector<const Point*> fastest_of_each_method(const std::vector<Point>& points,
                                                 const Reference& reference, double accuracy);

// Finds the margins of the rows on the scene, whose largest frequency is looked for once.
void add_stability_margins(std::vector<FrontRow>& rows, const ReducedScene& scene);

}  // namespace qddot::measure
