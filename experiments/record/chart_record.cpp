#include "experiments/record/chart_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace qddot::record {
namespace {

constexpr const char* null = "null";

std::string json(bool value) { return value ? "true" : "false"; }
std::string json(double value) {
  return std::isfinite(value) ? fmt::format("{:.17g}", value) : null;
}
std::string json(std::size_t value) { return std::to_string(value); }
// Words of the library: UTF-8 with no control characters but ends of lines.
std::string json(std::string_view words) {
  std::string text = "\"";
  for (const char c : words) {
    if (c == '"' || c == '\\') text += '\\';
    if (c == '\n') {
      text += "\\n";
    } else {
      text += c;
    }
  }
  return text + '"';
}
std::string json(const char* words) { return json(std::string_view(words)); }
std::string json(const std::string& words) { return json(std::string_view(words)); }

// [ , , ] of what `each` gives, with `separator` between.
template <class Values, class Each>
std::string list(const Values& values, const Each& each, const char* separator = ", ") {
  std::string text;
  for (const auto& value : values) {
    if (!text.empty()) text += separator;
    text += each(value);
  }
  return '[' + text + ']';
}
template <class Values>
std::string list(const Values& values) {
  return list(values, [](const auto& value) { return json(value); });
}

// Lists whose items have a line each.
constexpr const char* lines = ",\n  ";

std::string point_number(const Chart& chart, const Point* point) {
  return point ? json(chart.number(point)) : null;
}

std::string numbers(const Chart& chart, const std::vector<const Point*>& points) {
  return list(points, [&](const Point* point) { return json(chart.number(point)); });
}

// A list with what `of` gives of each point and its judgement.
template <class Of>
std::string column(const Chart& chart, const ChartView& view, const Of& of) {
  std::string text;
  for (std::size_t i = 0; i < view.points.size(); ++i)
    text += (i > 0 ? ", " : "") + json(of(chart.points[i], view.points[i]));
  return '[' + text + ']';
}

// The lengths [m] by which position errors are divided: the least and the largest of the parts'.
std::string displacements(const Scales& scales) {
  if (!(scales.displacement > 0)) return null;
  std::vector<double> lengths;
  for (const PartScale& part : scales.parts) lengths.push_back(scales.displacement_of(part));
  if (lengths.empty()) lengths.push_back(scales.displacement);
  const auto [least, largest] = std::ranges::minmax(lengths);
  return list(std::vector{least, largest});
}

const char* column_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::position:
      return "error_position";
    case Quantity::energy:
      return "error_energy_max";
    case Quantity::momentum:
      return "error_momentum_max";
    case Quantity::modes:
      return "error_modal_shares";
  }
  return "";
}

std::string json(const Chart& chart, const ChartView& view) {
  const auto of_each = [&](const auto& of) { return column(chart, view, of); };
  return fmt::format(
      R"({{"name": {}, "column": {}, "floor": {}, "floor_words": {}, "rounding_decides_below": {},
  "front": {},
  "staircase": {},
  "errors": {},
  "at_least": {},
  "at_most": {},
  "counts_at": {},
  "is_lucky": {},
  "counts": {},
  "is_uncertain": {},
  "failures": {}}})",
      json(name(view.quantity)), json(column_of(view.quantity)), json(view.floor),
      json(floor_in_words(view)), json(view.rounding_decides_below),
      list(
          view.front,
          [&](const FrontRow& row) {
            return fmt::format(R"({{"accuracy": {}, "point": {}, "ranked": {}}})",
                               json(row.accuracy), point_number(chart, row.fastest),
                               numbers(chart, row.ranked));
          },
          lines),
      list(view.staircase), of_each([](const Point&, const Judged& j) { return j.error; }),
      of_each([](const Point&, const Judged& j) { return j.bounds.at_least; }),
      of_each([](const Point&, const Judged& j) { return j.bounds.at_most; }),
      of_each([](const Point&, const Judged& j) { return j.counts_at; }),
      of_each([](const Point&, const Judged& j) { return j.is_lucky; }),
      of_each([](const Point&, const Judged& j) { return j.counts; }),
      of_each([](const Point&, const Judged& j) { return j.is_uncertain; }),
      of_each([](const Point& p, const Judged& j) { return failure_in_words(p, j); }));
}

// How many times as long a point takes as the fastest one of the row.
double ratio(const FrontRow& row, const Point* point) {
  return point ? point->time / row.fastest->time : std::nan("");
}

// The fastest of each family but that of the fastest point.
std::string others(const Chart& chart, const FrontRow& row) {
  std::vector<const Point*> best;
  for (const Point* point : {row.fastest_hand_written, row.fastest_sundials}) {
    if (point && point != row.fastest) best.push_back(point);
  }
  return list(best, [&](const Point* point) {
    return fmt::format(R"({{"family": {}, "point": {}, "ratio": {}}})",
                       json(family_name(point->method->family)), point_number(chart, point),
                       json(ratio(row, point)));
  });
}

std::string json(const Chart& chart, const FrontRow& row) {
  return fmt::format(
      R"({{"accuracy": {}, "point": {}, "why_empty": {}, "ranked": {}, "runner_up": {}, "ratio": {}, )"
      R"("hand_written": {}, "sundials": {}, "others": {}, "margin": {}, "warnings": {}}})",
      json(row.accuracy), point_number(chart, row.fastest),
      row.fastest ? null : json(why_empty(row, chart.reference)), numbers(chart, row.ranked),
      point_number(chart, row.runner_up()), json(ratio(row, row.runner_up())),
      point_number(chart, row.fastest_hand_written), point_number(chart, row.fastest_sundials),
      others(chart, row), json(row.stability_margin), list(warnings(row, chart.reference)));
}

std::vector<std::string> caveats_of(const Chart& chart, const StudyEnd& end) {
  std::vector<std::string> all = caveats(chart.reference, end);
  if (const std::string words = disturbance_in_words(chart); !words.empty()) all.push_back(words);
  return all;
}

}  // namespace

const char* const chart_beginning = "{\"format\": 1, \"judged_by\": ";

std::string chart_record(const Chart& chart, const std::string& scene, const StudyEnd& end) {
  const double bound = certified(chart.reference);
  return fmt::format(
      R"({}{}, "scene": {}, "until": {},
 "certified": {},
 "accuracies": {},
 "caveats": {},
 "displacements": {},
 "knobs": {},
 "times": {},
 "margins": {},
 "quantities": {},
 "rows": {},
 "staircases": {{"all": {}, "hand_written": {}, "sundials": {}}},
 "crossings": {}}}
)",
      chart_beginning, json(name(chart.judge)), scene, json(chart.reference.end.t),
      bound > 0 ? json(bound) : null, list(chart.accuracies), list(caveats_of(chart, end)),
      displacements(chart.reference.scales),
      list(chart.points,
           [](const Point& point) { return json(knob_in_words(*point.method, point.value)); }),
      list(chart.points,
           [](const Point& point) {
             return is_timed(point) ? json(time_in_words(point.time)) : null;
           }),
      list(chart.margins),
      list(
          chart.views, [&](const ChartView& view) { return json(chart, view); }, ",\n "),
      list(
          chart.front, [&](const FrontRow& row) { return json(chart, row); }, lines),
      list(chart.judged_view().staircase), list(chart.hand_written), list(chart.sundials),
      list(chart.crossings, [](const FrontCrossing& one) {
        return fmt::format(R"({{"accuracy": {}, "from": {}, "to": {}}})", json(one.accuracy),
                           json(one.from->name), json(one.to->name));
      }));
}

}  // namespace qddot::record
