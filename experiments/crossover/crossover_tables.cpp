#include "experiments/crossover/crossover_tables.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/points.hpp"

namespace qddot::crossover {
namespace {

std::string name_of(const Point* point) { return point ? point->method->name : ""; }
double time_of(const Point* point) {
  return point ? point->time : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Columns<WinnerRow> winner_columns() {
  using Row = const WinnerRow&;
  return {
      {"stiffness_ratio", &WinnerRow::ratio},
      {"accuracy", [](Row r) { return r.placing.accuracy; }},
      {"method", [](Row r) { return name_of(r.placing.fastest); }},
      {"time_s", [](Row r) { return time_of(r.placing.fastest); }},
      {"runner_up", [](Row r) { return name_of(r.placing.runner_up); }},
      {"margin", [](Row r) { return time_of(r.placing.runner_up) / time_of(r.placing.fastest); }}};
}

Columns<KindRow> kind_columns() {
  return {{"stiffness_ratio", &KindRow::ratio},
          {"accuracy", &KindRow::accuracy},
          {"kind", [](const KindRow& r) { return kind_name(r.kind); }},
          {"method", [](const KindRow& r) { return name_of(r.fastest); }},
          {"time_s", [](const KindRow& r) { return time_of(r.fastest); }}};
}

std::vector<std::string> point_columns_with_ratio() {
  std::vector<std::string> columns = point_columns().header();
  columns.insert(columns.begin(), "stiffness_ratio");
  return columns;
}

void tabulate(const AtRatio& one, const std::vector<const Method*>& competing,
              RowTable<WinnerRow>& winners, RowTable<KindRow>& of_kinds, Table& points) {
  for (const Placing& placing : one.placings) {
    winners.add({one.ratio, placing});
    for (const Kind kind : kinds) {
      if (std::ranges::none_of(competing, [&](auto m) { return kind_of(*m) == kind; })) continue;
      of_kinds.add(
          {one.ratio, placing.accuracy, kind, placing.of_kind[static_cast<std::size_t>(kind)]});
    }
  }
  for (const Point& point : one.points) {
    points->field(one.ratio);
    point_columns().write_row(*points,
                              {one.subject.drawn.name, point, one.reference->certified.position});
  }
}

nlohmann::json origin_of(const Program& p, const std::vector<AtRatio>& all) {
  nlohmann::json origin = p.origin();
  origin["family"] = all.front().subject.source;
  origin["until"] = all.front().subject.until;
  for (const AtRatio& one : all) {
    const auto whole = p.origin(one.subject);
    nlohmann::json entry = {{"stiffness_ratio", one.ratio},
                            {"scene", whole.at("scene")},
                            {"reduced", whole.at("reduced")},
                            {"certified_position", nullptr},
                            {"reference_made_by", nullptr}};
    if (one.reference) {
      entry["certified_position"] = one.reference->certified.position;
      entry["reference_made_by"] = one.reference->made_by;
    }
    origin["scenes"].push_back(entry);
  }
  return origin;
}

void print_winners(const std::vector<AtRatio>& all) {
  for (std::size_t row = 0; row < Pruning::accuracies.size(); ++row) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < all.size();) {
      const std::string name = name_of(all[i].placings[row].fastest);
      std::size_t last = i;
      while (last + 1 < all.size() && name_of(all[last + 1].placings[row].fastest) == name) ++last;
      const std::string what = name.empty() ? "nothing" : name;
      words.push_back(i == last
                          ? fmt::format("{} at {:g}", what, all[i].ratio)
                          : fmt::format("{} {:g} to {:g}", what, all[i].ratio, all[last].ratio));
      i = last + 1;
    }
    fmt::print("{:.0e}  {}\n", Pruning::accuracies[row], fmt::join(words, ", "));
  }
  for (const AtRatio& one : all) {
    if (!one.reference || one.reference->certified.position <= Pruning::accuracies.back()) continue;
    fmt::print(
        "at ratio {:g} the reference is certified to {:.1e}: smaller accuracies have no fastest "
        "method\n",
        one.ratio, one.reference->certified.position);
  }
}

}  // namespace qddot::crossover
