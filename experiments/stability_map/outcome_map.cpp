#include "experiments/stability_map/outcome_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/points.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/stability_map/linear_tables.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::stability_map {

// nlohmann::json finds its functions by this name.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunOutcome, outcome, growth_rate, t_reached, energy_end,
                                   energy_max, mean_step, counts)

namespace {

Options options_of(const Cell& cell) {
  Options options;
  options.rtol = cell.rtol;
  if (cell.method->knob == Knob::step_size) options.step_size = cell.h_omega / cell.row->omega_max;
  return options;
}

// The name of a cell, which depends on no other cells.
std::string name_of(const Cell& cell) {
  return fmt::format("run {} {:.17g} {:.17g} {:.17g}", cell.method->name, cell.row->amplitude,
                     cell.h_omega, cell.rtol);
}

RunOutcome fate_in(const Cell& cell, const MapSettings& settings) {
  try {
    return run_outcome(*cell.method, options_of(cell), *cell.row->scene,
                       {.rest_energy = cell.row->rest_energy,
                        .tolerated = settings.tolerated,
                        .until = settings.until,
                        .seconds = settings.seconds});
  } catch (const std::exception&) {  // may not leave a thread
    return {.outcome = std::string(name(Outcome::solver_failed))};
  }
}

}  // namespace

double predicted_growth_rate(const Cell& cell) {
  constexpr double no_rate = std::numeric_limits<double>::quiet_NaN();
  if (!has_linear_step(*cell.method)) return no_rate;
  const double h = cell.h_omega / cell.row->omega_max;
  double largest = -std::numeric_limits<double>::infinity();
  try {
    for (const Mode& mode : cell.row->modes) {
      const LinearStep step = linear_step(*cell.method, h * mode.omega);
      largest = std::max(largest, std::log(step.spectral_radius()) / h);
    }
  } catch (const std::exception&) {  // a step so long that its numbers overflow
    return no_rate;
  }
  return largest;
}

std::vector<const Method*> mapped(const std::vector<const Method*>& methods, bool are_named) {
  std::vector<const Method*> chosen;
  for (const Method* method : methods) {
    const bool is_fixed = method->knob == Knob::step_size && method->order > 0;
    if (are_named ? is_fixed || method->knob == Knob::rtol
                  : is_fixed && method->family == Family::hand_written) {
      chosen.push_back(method);
    }
  }
  return chosen;
}

std::vector<Cell> cells_of(const std::vector<const Method*>& methods,
                           const std::vector<AmplitudeRow>& rows,
                           const std::vector<double>& h_omegas) {
  std::vector<Cell> cells;
  for (const Method* method : methods) {
    for (const AmplitudeRow& row : rows) {
      if (!applies_to(*method, row.scene->system())) continue;
      if (method->knob == Knob::rtol) {
        for (const double rtol : tolerances) cells.push_back({method, &row, 0, rtol});
      } else {
        for (const double h_omega : h_omegas) cells.push_back({method, &row, h_omega, 0});
      }
    }
  }
  return cells;
}

void run_outcomes(Study& study, const std::vector<Cell>& cells, const MapSettings& settings,
                  Outcomes& all) {
  all.resize(cells.size());
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return cells[i].h_omega; });
  progress().begin(cells.size());
  side_by_side(order.size(), [&](std::size_t k) {
    const Cell& cell = cells[order[k]];
    all[order[k]] =
        study.piece(name_of(cell), [&] { return nlohmann::json(fate_in(cell, settings)); });
    progress().finish("runs of the map");
  });
}

const std::vector<std::string>& map_columns() {
  static const std::vector<std::string> columns = {"method",
                                                   "h",
                                                   "h_omega",
                                                   "amplitude",
                                                   "outcome",
                                                   "growth_rate",
                                                   "predicted_growth_rate",
                                                   "t_reached",
                                                   "energy_end",
                                                   "energy_max",
                                                   "steps",
                                                   "rejected",
                                                   "knob",
                                                   "value",
                                                   "omega_max",
                                                   "buckling_rate"};
  return columns;
}

void tabulate(Csv& csv, const std::vector<Cell>& cells, const Outcomes& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i]) continue;
    const Cell& cell = cells[i];
    const RunOutcome& result = *all[i];
    const double h = result.mean_step, omega = cell.row->omega_max;
    const bool is_fixed = cell.method->knob == Knob::step_size;
    csv.row(cell.method->name, is_fixed ? cell.h_omega / omega : h,
            is_fixed ? cell.h_omega : h * omega, cell.row->amplitude, result.outcome,
            result.growth_rate, predicted_growth_rate(cell), result.t_reached, result.energy_end,
            result.energy_max, result.counts.steps, result.counts.rejected,
            knob_name(cell.method->knob), is_fixed ? cell.h_omega / omega : cell.rtol, omega,
            cell.row->buckling_rate);
  }
}

void print(const std::vector<Cell>& cells, const Outcomes& all) {
  std::vector<const Method*> order;
  std::map<const Method*, std::map<std::string, int>> counts;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i]) continue;
    if (!counts.contains(cells[i].method)) order.push_back(cells[i].method);
    ++counts[cells[i].method][all[i]->outcome];
  }
  for (const Method* method : order) {
    fmt::print("{:<24}", method->name);
    for (const auto& [outcome, count] : counts[method]) fmt::print(" {} {}", count, outcome);
    fmt::print("\n");
  }
}

}  // namespace qddot::stability_map
