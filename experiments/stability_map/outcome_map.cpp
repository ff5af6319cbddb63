#include "experiments/stability_map/outcome_map.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/summary_record.hpp"
#include "qddot/measure/motion/interruption.hpp"
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

std::vector<std::optional<RunOutcome>> run_outcomes(
    Study& study, const std::vector<Cell>& cells, const MapSettings& settings,
    const std::function<void(std::size_t done)>& progress) {
  std::vector<std::optional<RunOutcome>> all(cells.size());
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return cells[i].h_omega; });
  std::size_t done = 0;
  std::exception_ptr trouble;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Cell& cell = cells[order[i]];
    try {
      all[order[i]] =
          study.piece(name_of(cell), [&] { return nlohmann::json(fate_in(cell, settings)); });
#pragma omp critical
      progress(++done);
    } catch (const Interrupted&) {
      // may not leave a thread
    } catch (...) {  // which cannot leave a thread
#pragma omp critical
      trouble = std::current_exception();
    }
  }
  if (trouble) std::rethrow_exception(trouble);
  return all;
}

}  // namespace qddot::stability_map
