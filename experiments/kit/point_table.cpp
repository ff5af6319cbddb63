#include "experiments/kit/point_table.hpp"

#include <limits>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "experiments/kit/method_options.hpp"
#include "qddot/measure/speed/judgement.hpp"

namespace qddot::inline kit {
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

}  // namespace qddot::inline kit
