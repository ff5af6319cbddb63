#include "experiments/stability_map/outcome_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/stability_map/linear_tables.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

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

constexpr int modes_predicted = 48;

// Throws InvalidInput unless there is a generator of that name with that parameter.
void require_parameter(const std::string& name, const std::string& vary) {
  const Generator* generator = find_generator(name);
  if (!generator) {
    throw InvalidInput(fmt::format(
        "--vary {}: scene {} is not a generator's, whose parameters can be varied", vary, name));
  }
  std::vector<std::string> names;
  for (const GeneratorParameter& parameter : generator->parameters) names.push_back(parameter.name);
  if (std::ranges::find(names, vary) != names.end()) return;
  throw InvalidInput(fmt::format("--vary {}: it is not a parameter of generator {}; allowed are {}",
                                 vary, name, fmt::join(names, ", ")));
}

// The scene as a generator draws it with its parameter `vary` set.
Scene drawn_with(const std::string& name, const std::string& vary, double value) {
  return generate(*find_generator(name), {{vary, value}}, name);
}

// The scene with each node's distance from its place at rest multiplied by `amplitude`, velocities
// likewise.
Scene scaled(const Scene& start, const Scene& rest, double amplitude) {
  Scene scene = start;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    Node& node = scene.nodes[i];
    const Eigen::Vector3d& origin = rest.nodes[i].position;
    node.position = origin + amplitude * (node.position - origin);
    node.velocity *= amplitude;
  }
  return scene;
}

double energy_at_rest(const Scene& rest) {
  const Model scene(rest, Reductions::only({Reduction::pins}));
  return scene.potential(scene.initial());
}

AmplitudeRow row_of(double amplitude, const Scene& start, double rest_energy,
                    const Reductions& reductions) {
  AmplitudeRow row{.amplitude = amplitude,
                   .scene = std::make_unique<Model>(start, reductions),
                   .rest_energy = rest_energy,
                   .omega_max = 0,
                   .buckling_rate = 0,
                   .modes = {}};
  const System& system = row.scene->system();
  const Vec& q = row.scene->initial().q;
  row.modes = sampled_modes(system, q, modes_predicted);
  row.omega_max = row.modes.empty() ? 0 : row.modes.back().omega;
  row.buckling_rate = buckling_rate(system, q);
  return row;
}

bool moves(const AmplitudeRow& row) {
  return row.omega_max > 0 && row.scene->energy(row.scene->initial()) > row.rest_energy;
}

}  // namespace

double omega_max_of(const Model& scene) {
  const NaturalModes highest = highest_modes(scene.system(), scene.initial().q, 1);
  return highest.squares.size() == 0 ? 0 : std::sqrt(std::max(0.0, highest.squares[0]));
}

std::vector<AmplitudeRow> rows_of(const Subject& subject, const Reductions& reductions,
                                  const std::optional<Scene>& rest, const std::string& vary,
                                  const std::vector<double>& amplitudes) {
  const bool is_varied = !vary.empty();
  if (is_varied) require_parameter(subject.source, vary);
  if (!is_varied && !rest) return {};
  const auto make = [&](double amplitude) {
    if (!is_varied) {
      return row_of(amplitude, scaled(subject.start(), *rest, amplitude), energy_at_rest(*rest),
                    reductions);
    }
    const Scene scene = drawn_with(subject.source, vary, amplitude);
    return row_of(amplitude, scene, energy_at_rest(settled(scene, subject.source)), reductions);
  };
  std::vector<std::string> left_out;
  std::vector<AmplitudeRow> rows;
  for (const double amplitude : amplitudes) {
    try {
      AmplitudeRow row = make(amplitude);
      if (moves(row)) {
        rows.push_back(std::move(row));
      } else {
        left_out.push_back(fmt::format("amplitude {:g}: nothing moves", amplitude));
      }
    } catch (const InvalidInput& error) {
      left_out.emplace_back(error.what());
    } catch (const std::runtime_error& error) {  // numbers that overflow
      left_out.push_back(fmt::format("amplitude {:g}: {}", amplitude, error.what()));
    }
  }
  if (is_varied && rows.empty() && !left_out.empty()) throw InvalidInput(left_out.front());
  for (const std::string& why : left_out)
    say(in_one_line("stability_map: warning: " + why + "; its row is left out"));
  return rows;
}

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
