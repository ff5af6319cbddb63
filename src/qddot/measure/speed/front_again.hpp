#pragma once

#include <functional>
#include <vector>

#include "qddot/measure/speed/front.hpp"

namespace qddot::inline measure {

// Times again what decides a chart: the fastest point at each accuracy, and those of other methods
// whose least time is at most `rival_time` of its median. All points were measured one after
// another, so a disturbance that lasts can spoil any of them. `measure` takes a point again.
// Returns the new points.
constexpr double rival_time = 1.2;
std::vector<Point> time_front_again(const std::vector<Point>& points, const Reference& reference,
                                    const std::vector<double>& accuracies,
                                    const std::function<Point(const Point&)>& measure);

// Gives each point the smaller of its median time and that of its repetition, if it has one.
void take_smaller_times(std::vector<Point>& points, const std::vector<Point>& again);

}  // namespace qddot::inline measure
