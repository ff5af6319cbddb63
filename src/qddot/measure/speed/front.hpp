#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "qddot/measure/speed/judgement.hpp"

namespace qddot::inline measure {

// The fastest points at one accuracy, of all methods and of each family; nullptr if there is none.
// A point has reached the accuracy if the error at which it counts is at most that (see
// judgement.hpp).
// The first of equally fast points counts as the fastest.
struct FrontRow {
  double accuracy = 0;
  bool may_be_reached = false;         // by a point whose error is uncertain
  std::vector<const Point*> ranked{};  // the fastest point of each method, the fastest first
  const Point* fastest = nullptr;
  const Point* fastest_hand_written = nullptr;
  const Point* fastest_sundials = nullptr;
  // The stability margin of the fastest point (see StabilityMargins); NaN if it has none.
  double stability_margin = std::numeric_limits<double>::quiet_NaN();

  // The fastest point of any other method than the fastest one's; nullptr if there is none.
  const Point* runner_up() const { return ranked.size() > 1 ? ranked[1] : nullptr; }
};

// Whether the run reached the end and its time is known.
bool is_timed(const Point& point);

// Whether the rival is slower by less than the times of either vary between runs.
bool may_be_faster(const Point& rival, const Point& fastest);

// Replaces `fastest`, which may be nullptr, by `point` if `point` takes less time.
void keep_faster(const Point*& fastest, const Point& point);

// The front: one row for each accuracy, with pointers into `points`, by the quantity that decides.
std::vector<FrontRow> fastest_at_each_accuracy(
    const std::vector<Point>& points, const Reference& reference,
    const std::vector<double>& accuracies = usual_accuracies());
// The front by another quantity.
std::vector<FrontRow> fastest_at_each_accuracy(const std::vector<Point>& points,
                                               const Reference& reference,
                                               const std::vector<double>& accuracies,
                                               Quantity quantity);

// The distance of a point's step to its stability limit: 1 - h / (limit / w_max), w_max at the
// start. Motion may raise w_max, so that a longer run blows up if the margin is small.
class StabilityMargins {
 public:
  // `w_max` [rad/s]; 0 if it is not known.
  explicit StabilityMargins(double w_max) : w_max_(w_max) {}
  // With the largest frequency of the scene, which is computed when a point asks for it.
  explicit StabilityMargins(const Model& scene) : scene_(&scene) {}

  // NaN for methods without fixed steps or without a limit, and if w_max is unknown.
  double of(const Point& point);

 private:
  double w_max();

  const Model* scene_ = nullptr;
  std::optional<double> w_max_;
};

// Computes the stability margins of the rows' fastest points.
void add_stability_margins(std::vector<FrontRow>& rows, StabilityMargins margins);

}  // namespace qddot::inline measure
