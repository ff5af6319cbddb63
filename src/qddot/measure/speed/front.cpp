#include "qddot/measure/speed/front.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

// The stability limit in h w; zero for methods that have none.
double limit_of(const Method& method) {
  if (!has_linear_step(method)) return 0;
  const double limit = linear_limit(method);
  return std::isfinite(limit) ? limit : 0;
}

// Enters a point that has reached the accuracy.
void enter(std::vector<const Point*>& ranked, const Point& point) {
  const auto own = std::ranges::find(ranked, point.method, &Point::method);
  if (own == ranked.end()) {
    ranked.push_back(&point);
  } else {
    keep_faster(*own, point);
  }
}

const Point* first_of(const std::vector<const Point*>& ranked, Family family) {
  const auto found = std::ranges::find_if(
      ranked, [&](const Point* point) { return point->method->family == family; });
  return found == ranked.end() ? nullptr : *found;
}

}  // namespace

bool is_timed(const Point& point) {
  return point.outcome == Outcome::reached_end && point.time > 0 && std::isfinite(point.time);
}

bool may_be_faster(const Point& rival, const Point& fastest) {
  return (is_disturbed(rival) || is_disturbed(fastest)) && rival.time_min < fastest.time;
}

void keep_faster(const Point*& fastest, const Point& point) {
  if (!fastest || point.time < fastest->time) fastest = &point;
}

std::vector<FrontRow> fastest_at_each_accuracy(const std::vector<Point>& points,
                                               const Reference& reference,
                                               const std::vector<double>& accuracies,
                                               Quantity quantity) {
  const std::vector<Judged> errors = judged_together(points, reference, quantity);
  std::vector<FrontRow> rows;
  for (const double accuracy : accuracies) {
    FrontRow row{.accuracy = accuracy};
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!is_timed(points[i])) continue;
      row.may_be_reached |= errors[i].may_be_within(accuracy);
      if (errors[i].is_within(accuracy)) enter(row.ranked, points[i]);
    }
    std::ranges::sort(row.ranked, [](const Point* one, const Point* other) {
      return one->time != other->time ? one->time < other->time : one < other;
    });
    row.fastest = row.ranked.empty() ? nullptr : row.ranked.front();
    row.fastest_hand_written = first_of(row.ranked, Family::hand_written);
    row.fastest_sundials = first_of(row.ranked, Family::sundials);
    rows.push_back(row);
  }
  return rows;
}

std::vector<FrontRow> fastest_at_each_accuracy(const std::vector<Point>& points,
                                               const Reference& reference,
                                               const std::vector<double>& accuracies) {
  return fastest_at_each_accuracy(points, reference, accuracies, judge_of(reference));
}

double StabilityMargins::of(const Point& point) {
  const double limit = limit_of(*point.method);
  if (!(limit > 0) || !(w_max() > 0)) return std::numeric_limits<double>::quiet_NaN();
  return 1 - point.value * w_max() / limit;
}

double StabilityMargins::w_max() {
  if (!w_max_) {
    try {
      w_max_ = quick_frequency(scene_->system(), scene_->initial().q);
    } catch (const std::exception&) {  // it was not found, and so no margin is known
      w_max_ = 0;
    }
  }
  return *w_max_;
}

void add_stability_margins(std::vector<FrontRow>& rows, StabilityMargins margins) {
  for (FrontRow& row : rows) {
    if (row.fastest) row.stability_margin = margins.of(*row.fastest);
  }
}

}  // namespace qddot::inline measure
