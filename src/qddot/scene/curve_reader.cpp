#include "qddot/scene/curve_reader.hpp"

#include <algorithm>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace qddot {
namespace {

TimeCurve::Harmonic harmonic_in(const TomlTable& table, int dimension) {
  table.allow_keys({"amplitude", "frequency", "angular_frequency", "phase"});
  if (table.has("frequency") == table.has("angular_frequency"))
    table.fail("frequency",
               "allowed is exactly one of frequency, in Hz, and angular_frequency, in rad/s");
  const double frequency = table.has("frequency")
                               ? 2 * std::numbers::pi * table.number("frequency", not_negative)
                               : table.number("angular_frequency", not_negative);
  return {table.vector("amplitude", dimension), frequency, table.number_or(0, "phase")};
}

PiecewiseCubic table_in(const TomlTable& table, int dimension) {
  table.allow_keys({"times", "values", "interpolation"});
  std::vector<double> times = table.numbers("times");
  std::vector<Eigen::Vector3d> values = table.vectors("values", dimension);
  if (times.size() < 2 || !std::ranges::is_sorted(times, std::less_equal<>()))
    table.refuse("times", "two and more finite numbers that ascend");
  if (values.size() != times.size())
    table.fail("values", fmt::format("{} of them for {} times; allowed is one for each",
                                     values.size(), times.size()));
  const std::string way =
      table.has("interpolation") ? table.text("interpolation") : std::string("spline");
  if (way == "spline") return PiecewiseCubic::spline(std::move(times), std::move(values));
  if (way != "linear") table.refuse("interpolation", "\"spline\" and \"linear\"");
  return PiecewiseCubic::straight(std::move(times), std::move(values));
}

TimeCurve curve_in(const TomlTable& table, int dimension) {
  TimeCurve curve;
  if (table.has("polynomial")) curve.polynomial = table.vectors("polynomial", dimension);
  for (const TomlTable& harmonic : table.tables("harmonics"))
    curve.harmonics.push_back(harmonic_in(harmonic, dimension));
  if (table.has("table")) curve.tables.push_back(table_in(table.table("table"), dimension));
  if (curve.polynomial.empty() && curve.harmonics.empty() && curve.tables.empty())
    table.fail("polynomial", "a curve needs one at least of polynomial, harmonics and table");
  return curve;
}

}  // namespace

CurveReader::CurveReader(const TomlTable& file, Scene& scene) : scene_(scene) {
  for (const TomlTable& table : file.tables("curves")) {
    table.allow_keys({"name", "polynomial", "harmonics", "table"});
    const auto number = static_cast<int>(scene.curves.size());
    if (!numbers_.try_emplace(table.text("name"), number).second)
      table.fail("name", "another curve has this name; allowed is each name once");
    scene.curves.push_back(curve_in(table, scene.dimension));
  }
}

int CurveReader::read(const TomlTable& table, std::string_view key) const {
  if (!table.has(key)) return -1;
  if (table.is_text(key)) {
    const auto found = numbers_.find(table.text(key));
    if (found != numbers_.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [name, number] : numbers_) names.push_back(name);
    table.refuse(key, names.empty() ? "tables, and names of [[curves]], of which there are none"
                                    : fmt::format("tables and {}", fmt::join(names, ", ")));
  }
  const TomlTable own = table.table(key);
  own.allow_keys({"polynomial", "harmonics", "table"});
  scene_.curves.push_back(curve_in(own, scene_.dimension));
  return static_cast<int>(scene_.curves.size()) - 1;
}

}  // namespace qddot
