#pragma once

#include <span>
#include <vector>

#include "qddot/measure/speed/front.hpp"

namespace qddot::inline measure {

// The points that no other point beats in both time and error, by their indices, from coarse to
// fine. A point's error is that at which it counts. Errors below the view's floor are not told
// apart.
using Staircase = std::vector<std::size_t>;

// The points of a chart over one kind of error.
struct ChartView {
  Quantity quantity{};
  // The least error that means anything: the certified error of positions, the difference by chance
  // of modal shares; NaN if there is no such limit or it is unknown.
  double floor = std::numeric_limits<double>::quiet_NaN();
  // The position error below which runs differ by how their methods round, in a chaotic motion, if
  // it is above the floor; else NaN.
  double rounding_decides_below = std::numeric_limits<double>::quiet_NaN();
  std::vector<Judged> points{};   // as many as the chart has
  std::vector<FrontRow> front{};  // at the usual accuracies, by this error alone
  Staircase staircase{};
};

// The fastest method changes at an accuracy, from that at the next coarser one.
struct FrontCrossing {
  double accuracy = 0;
  const Method *from = nullptr, *to = nullptr;
};

// The chart of work and precision: all that is said of the points of many methods on one scene.
// Borrows the points.
struct Chart {
  std::span<const Point> points;
  Reference reference;
  Quantity judge{};                // the quantity that decides
  std::vector<double> accuracies;  // from coarse to fine
  std::vector<FrontRow> front;     // at these accuracies, by the quantity that decides
  std::vector<double> margins{};   // the stability margin of each point; NaN if it has none
  std::vector<ChartView> views{};  // of positions, and of the other quantities that were measured
  Staircase hand_written{}, sundials{};  // of a family's points, by the quantity that decides
  std::vector<FrontCrossing> crossings{};

  // The view of the quantity that decides.
  const ChartView& judged_view() const;
  // The number of a point that a row of a front names.
  std::size_t number(const Point* point) const {
    return static_cast<std::size_t>(point - points.data());
  }
};

// Judges the points against the reference. `accuracies`: of the front, from coarse to fine.
Chart chart_of(const std::vector<Point>& points, const Reference& reference,
               const std::vector<double>& accuracies, StabilityMargins margins);

// The parameter at which two methods take equally long, between two scenes with its values `low`
// and `high`. `at_low` and `at_high` are the logarithms of the ratio of their times there. It is
// the zero of the line through these over the parameter's logarithm, or over the parameter if `low`
// is not above 0. NaN if a ratio is unknown.
double equally_long(double low, double high, double at_low, double at_high);

}  // namespace qddot::inline measure
