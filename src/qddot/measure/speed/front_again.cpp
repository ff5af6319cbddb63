#include "qddot/measure/speed/front_again.hpp"

#include <algorithm>
#include <set>

namespace qddot::inline measure {

std::vector<Point> time_front_again(const std::vector<Point>& points, const Reference& reference,
                                    const std::vector<double>& accuracies,
                                    const std::function<Point(const Point&)>& measure) {
  std::set<const Point*> decisive;
  for (const FrontRow& row : fastest_at_each_accuracy(points, reference, accuracies)) {
    for (const Point* point : row.ranked) {
      if (point->time_min <= rival_time * row.fastest->time) decisive.insert(point);
    }
  }
  std::vector<Point> again;
  for (const Point* point : decisive) again.push_back(measure(*point));
  return again;
}

void take_smaller_times(std::vector<Point>& points, const std::vector<Point>& again) {
  for (const Point& second : again) {
    if (!is_timed(second)) continue;
    const auto first = std::ranges::find_if(points, [&](const Point& point) {
      return point.method == second.method && point.value == second.value;
    });
    if (first == points.end()) continue;
    first->time = std::min(first->time, second.time);
    first->time_min = std::min(first->time_min, second.time_min);
    first->timed_runs += second.timed_runs;
  }
}

}  // namespace qddot::inline measure
