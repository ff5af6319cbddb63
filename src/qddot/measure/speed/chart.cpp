#include "qddot/measure/speed/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "qddot/measure/speed/chart_words.hpp"

namespace qddot::inline measure {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double known_or_nan(double value) { return value > 0 ? value : unknown; }

double floor_of(const Reference& reference, Quantity quantity) {
  if (quantity == Quantity::position) return known_or_nan(reference.certified.position);
  const bool has_shares = quantity == Quantity::modes && reference.is_beyond_horizon();
  return has_shares ? known_or_nan(reference.modal_shares_floor) : unknown;
}

double rounding_decides_below(const Reference& reference, Quantity quantity) {
  const bool is_said = quantity == Quantity::position && reference.is_chaotic() &&
                       !(reference.rounding_effect <= reference.certified.position);
  return is_said ? known_or_nan(reference.rounding_effect) : unknown;
}

// The staircase of the points that `takes` accepts.
template <class Takes>
Staircase staircase(std::span<const Point> points, const ChartView& view, const Takes& takes) {
  const auto is_drawn = [&](std::size_t i) {
    return failure_in_words(points[i], view.points[i]).empty();
  };
  double least = view.floor;
  if (std::isnan(least)) {
    least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double error = view.points[i].error;
      if (is_drawn(i) && error > 0) least = std::min(least, error);
    }
  }
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Judged& judged = view.points[i];
    if (is_drawn(i) && judged.counts && std::isfinite(judged.counts_at) && takes(points[i]))
      order.emplace_back(std::max(judged.counts_at, least), i);
  }
  std::ranges::stable_sort(order, [&](const auto& one, const auto& other) {
    return std::pair(one.first, points[one.second].time) <
           std::pair(other.first, points[other.second].time);
  });
  Staircase stairs;
  for (const auto& [error, i] : order) {
    if (stairs.empty() || points[i].time < points[stairs.back()].time) stairs.push_back(i);
  }
  std::ranges::reverse(stairs);
  return stairs;
}

ChartView view_of(const std::vector<Point>& points, const Reference& reference, Quantity quantity) {
  ChartView view{.quantity = quantity,
                 .floor = floor_of(reference, quantity),
                 .rounding_decides_below = rounding_decides_below(reference, quantity),
                 .points = judged_together(points, reference, quantity)};
  view.front = fastest_at_each_accuracy(points, reference, usual_accuracies(), quantity);
  view.staircase = staircase(points, view, [](const Point&) { return true; });
  return view;
}

std::vector<FrontCrossing> crossings_of(const std::vector<FrontRow>& front) {
  std::vector<FrontCrossing> crossings;
  const Method* before = nullptr;
  for (const FrontRow& row : front) {
    if (!row.fastest) continue;
    const Method* now = row.fastest->method;
    if (before && now != before) crossings.push_back({row.accuracy, before, now});
    before = now;
  }
  return crossings;
}

}  // namespace

const ChartView& Chart::judged_view() const {
  return *std::ranges::find(views, judge, &ChartView::quantity);
}

Chart chart_of(const std::vector<Point>& points, const Reference& reference,
               const std::vector<double>& accuracies, StabilityMargins margins) {
  Chart chart{.points = points,
              .reference = reference,
              .judge = judge_of(reference),
              .accuracies = accuracies,
              .front = fastest_at_each_accuracy(points, reference, accuracies)};
  add_stability_margins(chart.front, margins);
  for (const Point& point : points) chart.margins.push_back(margins.of(point));
  for (const Quantity quantity :
       {Quantity::position, Quantity::energy, Quantity::momentum, Quantity::modes}) {
    ChartView view = view_of(points, reference, quantity);
    const bool is_measured = std::ranges::any_of(view.points, [](const Judged& judged) {
      return judged.error > 0;  // nothing turns in what only swings in a plane
    });
    if (quantity == Quantity::position || quantity == chart.judge || is_measured)
      chart.views.push_back(std::move(view));
  }
  const auto stairs_of = [&](Family family) {
    return staircase(points, chart.judged_view(),
                     [&](const Point& point) { return point.method->family == family; });
  };
  chart.hand_written = stairs_of(Family::hand_written);
  chart.sundials = stairs_of(Family::sundials);
  chart.crossings = crossings_of(chart.front);
  return chart;
}

double equally_long(double low, double high, double at_low, double at_high) {
  const double part = at_low / (at_low - at_high);
  if (!std::isfinite(part)) return unknown;
  if (!(low > 0)) return low + (high - low) * part;
  return low * std::pow(high / low, part);
}

}  // namespace qddot::inline measure
