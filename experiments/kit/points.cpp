#include "experiments/kit/points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/scene/invalid_input.hpp"

// nlohmann::json looks for these functions in the namespace of the types.
namespace qddot::inline measure {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Errors, position, velocity, energy)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PathErrors, energy, momentum, modal_shares)

}  // namespace qddot::inline measure

namespace qddot::inline kit {

nlohmann::json record_of(const Point& p) {
  return {{"method", p.method->name},
          {"value", p.value},
          {"outcome", static_cast<int>(p.outcome)},
          {"t_reached", p.t_reached},
          {"errors", p.errors},
          {"path", p.path},
          {"time", p.time},
          {"time_min", p.time_min},
          {"setup", p.setup},
          {"timed_runs", p.timed_runs},
          {"counts", p.counts},
          {"energy_growth", p.energy_growth}};
}

Point point_of(const nlohmann::json& record) {
  return {.method = find_method(record.at("method").get<std::string>()),
          .value = record.at("value"),
          .outcome = static_cast<Outcome>(record.at("outcome").get<int>()),
          .t_reached = record.at("t_reached"),
          .errors = record.at("errors"),
          .path = record.at("path"),
          .time = record.at("time"),
          .time_min = record.at("time_min"),
          .setup = record.at("setup"),
          .timed_runs = record.at("timed_runs"),
          .counts = record.at("counts"),
          .energy_growth = record.at("energy_growth")};
}

std::function<Point(const Method&, double, const Effort::Take&)> points_of(Study& study,
                                                                           std::string prefix,
                                                                           std::string shown) {
  return [&study, prefix = std::move(prefix), shown = std::move(shown)](
             const Method& method, double value, const Effort::Take& take) {
    progress().now_at(fmt::format("{}{} {} = {:.3g}", shown, method.name,
                                  method.knob == Knob::step_size ? "h" : "rtol", value));
    const std::string name = fmt::format("{}{} {:.17g}", prefix, method.name, value);
    return point_of(study.piece(name, [&] { return record_of(take()); }));
  };
}

namespace {

using Row = PointRow;

double measured(const Row& row, double x) {
  const bool is = row.point.outcome == Outcome::reached_end;
  return is ? x : std::numeric_limits<double>::quiet_NaN();
}
// The bounds of the position error.
Known position(const Row& row) { return known(row.point.errors.position, row.certified); }

}  // namespace

const Columns<PointRow>& point_columns() {
  static const Columns<Row> columns = {
      {"scene", [](const Row& row) { return row.scene; }},
      {"method", [](const Row& row) { return row.point.method->name; }},
      {"knob", [](const Row& row) { return knob_name(row.point.method->knob); }},
      {"value", [](const Row& row) { return row.point.value; }},
      {"outcome", [](const Row& row) { return name(row.point.outcome); }},
      {"t_reached", [](const Row& row) { return row.point.t_reached; }},
      {"error_position", [](const Row& row) { return measured(row, row.point.errors.position); }},
      {"error_velocity", [](const Row& row) { return measured(row, row.point.errors.velocity); }},
      {"error_energy", [](const Row& row) { return measured(row, row.point.errors.energy); }},
      {"time_s", [](const Row& row) { return measured(row, row.point.time); }},
      {"time_min_s", [](const Row& row) { return measured(row, row.point.time_min); }},
      {"setup_s", [](const Row& row) { return measured(row, row.point.setup); }},
      {"steps", [](const Row& row) { return row.point.counts.steps; }},
      {"rejected", [](const Row& row) { return row.point.counts.rejected; }},
      {"force_evaluations", [](const Row& row) { return row.point.counts.force_evaluations; }},
      {"stiffness_evaluations",
       [](const Row& row) { return row.point.counts.stiffness_evaluations; }},
      {"factorizations", [](const Row& row) { return row.point.counts.factorizations; }},
      {"solves", [](const Row& row) { return row.point.counts.solves; }},
      {"newton_iterations", [](const Row& row) { return row.point.counts.newton_iterations; }},
      {"indefinite_factorizations",
       [](const Row& row) { return row.point.counts.indefinite_factorizations; }},
      {"order_mean", [](const Row& row) { return order_mean(row.point.counts); }},
      {"order_reductions", [](const Row& row) { return row.point.counts.order_reductions; }},
      {"stability_limited_steps",
       [](const Row& row) { return row.point.counts.stability_limited_steps; }},
      {"timed_runs", [](const Row& row) { return row.point.timed_runs; }},
      {"family", [](const Row& row) { return family_name(row.point.method->family); }},
      {"order", [](const Row& row) { return row.point.method->order; }},
      {"error_energy_max", [](const Row& row) { return measured(row, row.point.path.energy); }},
      {"error_momentum_max", [](const Row& row) { return measured(row, row.point.path.momentum); }},
      {"error_modal_shares",
       [](const Row& row) { return measured(row, row.point.path.modal_shares); }},
      {"error_position_at_least",
       [](const Row& row) { return measured(row, position(row).at_least); }},
      {"error_position_at_most",
       [](const Row& row) { return measured(row, position(row).at_most); }},
      {"energy_growth", [](const Row& row) { return row.point.energy_growth; }},
      {"stock_of", [](const Row& row) { return row.point.method->stock_of; }}};
  return columns;
}

nlohmann::json notes_on(const std::vector<Point>& points) {
  nlohmann::json methods = nlohmann::json::array();
  nlohmann::json outcomes = nlohmann::json::object();
  std::set<const Method*> noted;
  for (const Point& point : points) {
    const Method& method = *point.method;
    if (noted.insert(&method).second) {
      methods.push_back({{"name", method.name},
                         {"summary", method.summary},
                         {"takes", options_taken_by(method)}});
    }
    if (point.outcome != Outcome::reached_end)
      outcomes[std::string(name(point.outcome))] = advice(point.outcome);
  }
  return {{"methods", methods}, {"outcomes", outcomes}};
}

namespace {

const std::vector<std::string> columns_read = columns_in(
    "method value outcome t_reached error_position error_velocity error_energy "
    "error_energy_max error_momentum_max error_modal_shares time_s time_min_s setup_s steps "
    "energy_growth");

Point point_of(const WrittenTable& table, std::size_t row, const std::string& path) {
  const auto number = [&](const char* column) { return table.number(row, column); };
  const Method* method = find_method(table.text(row, "method"));
  const auto outcome = find_outcome(table.text(row, "outcome"));
  if (!method || !outcome) {
    throw InvalidInput(
        fmt::format("{}: row {}: {} '{}' is not known here; work_precision writes "
                    "such a table anew",
                    path, row + 1, method ? "outcome" : "method",
                    table.text(row, method ? "outcome" : "method")));
  }
  const double value = number("value");
  if (!(std::isfinite(value) && value > 0)) {
    throw InvalidInput(fmt::format("{}: row {}: value {} is not allowed; it is finite and above 0",
                                   path, row + 1, table.text(row, "value")));
  }
  return {.method = method,
          .value = value,
          .outcome = *outcome,
          .t_reached = number("t_reached"),
          .errors = {number("error_position"), number("error_velocity"), number("error_energy")},
          .path = {number("error_energy_max"), number("error_momentum_max"),
                   number("error_modal_shares")},
          .time = number("time_s"),
          .time_min = number("time_min_s"),
          .setup = number("setup_s"),
          .counts = {.steps = static_cast<std::int64_t>(number("steps"))},
          .energy_growth = number("energy_growth")};
}

// The options as the study was given them, read as a command line is.
void take_options(const nlohmann::json& given, MeasuredPoints& study) {
  Program program("study", "");
  const auto scene = program.scene();
  const auto options = program.method_options();
  std::vector<std::string> words = {"study"};
  for (const auto& [option, values] : given.items()) {
    if (option != "--no-reduce" && !decides_how_a_method_runs(option)) continue;
    for (const auto& value : values)
      words.push_back(fmt::format("{}={}", option, value.get<std::string>()));
  }
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  program.parse(static_cast<int>(argv.size()), argv.data());
  require_options(program, options);
  study.no_reduce = scene->no_reduce;
  study.options = options;
}

}  // namespace

std::vector<Point> points_in(const std::string& folder) {
  const std::string path = folder + "/points.csv";
  const WrittenTable table(path, columns_read);
  std::vector<Point> points;
  for (std::size_t row = 0; row < table.size(); ++row) points.push_back(point_of(table, row, path));
  return points;
}

MeasuredPoints measured_points(const std::string& folder) {
  MeasuredPoints study;
  study.points = points_in(folder);
  const std::string sidecar = folder + "/points.json";
  std::ifstream file(sidecar);
  const auto json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  try {
    study.key = json.at("study");
    const auto& about = study.key.at("about");
    study.scene_hash = about.at("scene");
    study.until = about.at("until");
    take_options(study.key.at("options"), study);
  } catch (const nlohmann::json::exception&) {
    throw InvalidInput(
        fmt::format("{}: it is missing or not as work_precision writes it beside "
                    "points.csv",
                    sidecar));
  }
  if (!(std::isfinite(study.until) && study.until > 0)) {
    throw InvalidInput(fmt::format(
        "{}: study.about.until {} is not allowed; it is finite and above 0", sidecar, study.until));
  }
  return study;
}

}  // namespace qddot::inline kit
