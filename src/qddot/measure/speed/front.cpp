#include "qddot/measure/speed/front.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {

void keep_faster(const Point*& fastest, const Point& point) {
  if (!fastest || point.time < fastest->time) fastest = &point;
}

const std::vector<double>& usual_accuracies() {
  static const std::vector<double> all = [] {
    std::vector<double> powers;
    for (int digit = 1; digit <= 9; ++digit) powers.push_back(std::pow(10.0, -digit));
    return powers;
  }();
  return all;
}

std::vector<FrontRow> fastest_at_each_accuracy(const std::vector<Point>& points,
                                               const Reference& reference,
                                               const std::vector<double>& accuracies) {
  std::vector<FrontRow> rows;
  for (const double accuracy : accuracies) {
    FrontRow row{.accuracy = accuracy};
    for (const Point& point : points) {
      if (point.outcome != Outcome::reached_end) continue;
      const Known error = known(judged_error(point, reference), certified(reference));
      row.may_be_reached |= error.at_least <= row.accuracy;
      if (!(error.at_most <= row.accuracy)) continue;
      keep_faster(row.fastest, point);
      keep_faster(point.method->family == Family::sundials ? row.fastest_sundials
                                                           : row.fastest_hand_written,
                  point);
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<const Point*> fastest_of_each_method(const std::vector<Point>& points,
                                                 const Reference& reference, double accuracy) {
  std::map<const Method*, const Point*> fastest;
  for (const Point& point : points) {
    if (point.outcome != Outcome::reached_end) continue;
    if (known(judged_error(point, reference), certified(reference)).at_most <= accuracy)
      keep_faster(fastest[point.method], point);
  }
  std::vector<const Point*> sorted;
  for (const auto& [method, point] : fastest) sorted.push_back(point);
  std::ranges::sort(sorted, {}, &Point::time);
  return sorted;
}

void add_stability_margins(std::vector<FrontRow>& rows, const ReducedScene& scene) {
  const System& system = scene.system();
  const auto has_limit = [](const FrontRow& row) {
    if (!row.fastest || !has_linear_step(*row.fastest->method)) return false;
    const double limit = linear_limit(*row.fastest->method);
    return limit > 0 && std::isfinite(limit);
  };
  if (std::ranges::none_of(rows, has_limit)) return;
  double w = 0;
  try {
    w = quick_frequency(system, scene.initial().q);
  } catch (const std::exception&) {  // it was not found, and so no margin is known
    return;
  }
  for (FrontRow& row : rows) {
    if (!has_limit(row) || w == 0) continue;
    row.stability_margin = 1 - row.fastest->value * w / linear_limit(*row.fastest->method);
  }
}

}  // namespace qddot::inline measure
