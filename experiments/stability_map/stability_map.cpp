// Where is each method stable, by theory and measured: on an oscillator, in the natural modes of a
// scene, and in its whole nonlinear motion?
//
//   stability_map --scene pendulum --out results/pendulum
//   stability_map --scene strut --vary compression --amplitudes 0.5,0.7,0.9 --out results/strut
//
//  1. limits.csv and linear.csv: every method of fixed steps on q'' = -w^2 q, where each step is a
//     matrix (linear_step.hpp). They have its spectral radius, damping ratio and period error for
//     h w from 0.01 to 100. They also have the h w at which it starts to grow, predicted and found
//     by bisection (linear_limit.hpp), and h as that h w over w_max of the scene at its start.
//     adaptive.csv: the steps of methods that choose them (chosen_steps.hpp).
//  2. modal.csv: the same in natural modes of the scene about its equilibrium at one h
//     (modal_step.hpp), predicted as in 1 and measured by exciting the mode.
//  3. map.csv: outcomes of whole runs over h w_max and amplitude (run_outcome.hpp). A run of
//     amplitude a starts at q_rest + a (q - q_rest), a v: a = 1 is the scene itself, small
//     amplitudes are linear. With --vary, the amplitude is a parameter of the generator. Each
//     method has --cell-limit for a run.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <omp.h>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/shared_seconds.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/stability_map/amplitude_rows.hpp"
#include "experiments/stability_map/chosen_steps.hpp"
#include "experiments/stability_map/modal_table.hpp"
#include "experiments/stability_map/outcome_map.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::stability_map {
namespace {

constexpr int linear_points = 60;  // a decade
constexpr int most_columns = 1000, most_amplitudes = 1000;
constexpr std::array tolerances = {1e-2, 1e-4, 1e-6};
constexpr std::array fast_frequencies = {1., 10., 100., 1000.};

struct Arguments {
  SceneChoice scene;
  std::string vary, out;
  std::vector<std::string> methods;
  std::vector<double> amplitudes = {0.03, 0.1, 0.3, 1, 3};
  double low = 0.1, high = 100, until = 0, step_size = 0, tolerated = 0.5, cell_limit = 0.3;
  int columns = 22;
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option(
          "--methods", a.methods,
          "a,b,...: the methods (default: all; in the map all hand-written ones of fixed steps)")
      .delimiter(',');
  line.add_option("--vary", a.vary,
                  "a parameter of the scene's generator, whose values are the amplitudes (default: "
                  "amplitudes are distances from rest, relative to the scene's)");
  line.add_option("--amplitudes", a.amplitudes,
                  "a,b,...: the amplitudes, one for each row of the map")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--low", a.low, "the least h w_max of the map").capture_default_str();
  line.add_option("--high", a.high, "the largest h w_max of the map").capture_default_str();
  line.add_option("--columns", a.columns, "number of columns of the map, from --low to --high")
      .capture_default_str();
  line.add_option("--until", a.until,
                  "the time to run to in s, at least 100 steps (default: the scene's own)");
  line.add_option("--step-size", a.step_size,
                  "the step size h in s for the modes (default: 1/w_max, w_max at rest)");
  line.add_option("--tolerated", a.tolerated,
                  "the part of the energy that a bounded run may lose or gain")
      .capture_default_str();
  line.add_option("--cell-limit", a.cell_limit,
                  "seconds that a run of the map may take; slower ones become over_budget")
      .capture_default_str();
  line.add_option("--out", a.out, "the folder for limits.csv, linear.csv, modal.csv, map.csv, ...");
}

void require(const Arguments& a) {
  require_given(a.out, "--out", "the folder for the results");
  require_within(a.columns, 1, most_columns, "--columns");
  require_positive(a.low, "--low", "the least h w_max");
  require_positive(a.high, "--high", "the largest h w_max");
  if (a.high < a.low) {
    throw InvalidInput(
        fmt::format("--high {} is not allowed; it is --low or more, {}", a.high, a.low));
  }
  require_positive(a.tolerated, "--tolerated", "a part of the energy");
  require_positive(a.cell_limit, "--cell-limit", "the seconds a run may take");
  if (a.amplitudes.size() > most_amplitudes) {
    throw InvalidInput(fmt::format("--amplitudes: {} of them are too many; allowed are {}",
                                   a.amplitudes.size(), most_amplitudes));
  }
  for (const double amplitude : a.amplitudes) {
    if (a.vary.empty()) require_positive(amplitude, "--amplitudes", "a distance from rest");
  }
}

// The rows of the map; empty if the scene has no equilibrium.
std::vector<AmplitudeRow> rows_of(const Arguments& a, const Scene& start,
                                  const std::optional<Scene>& rest) {
  const Reductions reductions = reductions_of(a.scene);
  std::vector<std::string> left_out;
  std::vector<AmplitudeRow> rows;
  if (!a.vary.empty()) {
    rows = varied_rows(a.scene.name, a.vary, a.amplitudes, reductions, &left_out);
  } else if (rest) {
    rows = scaled_rows(start, *rest, a.amplitudes, reductions, &left_out);
  }
  for (const std::string& why : left_out) {
    progress().wipe();
    fmt::print(stderr, "stability_map: warning: {}; its row is left out\n", in_one_line(why));
  }
  return rows;
}

std::vector<double> spaced(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / std::max(1, count - 1)));
  }
  return values;
}

struct Limit {
  const Method* method;
  double predicted, measured;  // of h w; infinite without a limit

  // The relative difference of the measured limit from the predicted one, if there is one.
  double difference() const { return (measured - predicted) / predicted; }
};

void add_limits(Study& study, const std::vector<const Method*>& methods,
                std::vector<Limit>& limits) {
  std::vector<const Method*> linear = methods;
  std::erase_if(linear, [](const Method* method) { return !has_linear_step(*method); });
  progress().begin(linear.size());
  for (const Method* method : linear) {
    progress().now_at("limit of " + method->name);
    const nlohmann::json limit = study.piece("limit " + method->name, [&] {
      return nlohmann::json{linear_limit(*method), measured_limit(*method)};
    });
    limits.push_back({method, limit.at(0), limit.at(1)});
    progress().finish("limit of " + method->name + " is found");
  }
}

void tabulate(Csv& csv, const std::vector<Limit>& limits, double omega_max) {
  for (const Limit& limit : limits) {
    csv.row(limit.method->name, limit.predicted / omega_max, limit.measured / omega_max,
            limit.predicted, limit.measured, limit.difference());
  }
}

void tabulate_linear(Csv& csv, const std::vector<const Method*>& methods) {
  const int points = static_cast<int>(std::log10(largest_h_omega / least_h_omega)) * linear_points;
  for (const Method* method : methods) {
    stop_if_interrupted();
    if (!has_linear_step(*method)) continue;
    for (const double h_omega : spaced(least_h_omega, largest_h_omega, points + 1)) {
      const LinearStep step = linear_step(*method, h_omega);
      csv.row(method->name, h_omega, step.spectral_radius(), step.damping_ratio(),
              step.period_error());
    }
  }
}

void tabulate_adaptive(Study& study, Csv& csv, const std::vector<const Method*>& methods) {
  std::vector<const Method*> adaptive = methods;
  std::erase_if(adaptive, [](const Method* method) {
    return method->knob != Knob::rtol || method->asks(Need::split_forces) ||
           !method->stock_of.empty();
  });
  progress().begin(adaptive.size());
  for (const Method* method : adaptive) {
    for (const double rtol : tolerances) {
      for (const double omega : fast_frequencies) {
        progress().now_at(fmt::format("steps of {} at rtol {:g}", method->name, rtol));
        const auto row =
            study.piece(fmt::format("steps {} {:g} {:g}", method->name, rtol, omega), [&] {
              const ChosenSteps s = chosen_steps(*method, rtol, omega);
              Csv csv_row;
              csv_row.row(method->name, rtol, omega, name(s.outcome), s.mean_h_omega, s.rejected,
                          s.fast_energy, s.energy_error, s.counts.steps, s.counts.rejected,
                          s.counts.stability_limited_steps);
              return nlohmann::json(csv_row.text());
            });
        csv.rows(row.get<std::string>());
      }
    }
    progress().finish("steps of " + method->name + " are measured");
  }
}

// The methods whose whole runs are mapped: all but SUNDIALS' fixed steps, which have hand-written
// twins.
std::vector<const Method*> followed(const Arguments& a, const std::vector<const Method*>& methods) {
  std::vector<const Method*> chosen;
  for (const Method* method : methods) {
    const bool is_fixed = method->knob == Knob::step_size && method->order > 0;
    if (a.methods.empty() ? is_fixed && method->family == Family::hand_written
                          : is_fixed || method->knob == Knob::rtol) {
      chosen.push_back(method);
    }
  }
  return chosen;
}

std::vector<Cell> cells_of(const Arguments& a, const std::vector<const Method*>& methods,
                           const std::vector<AmplitudeRow>& rows) {
  std::vector<Cell> cells;
  for (const Method* method : methods) {
    for (const AmplitudeRow& row : rows) {
      if (!applies_to(*method, row.scene->system())) continue;
      if (method->knob == Knob::rtol) {
        for (const double rtol : tolerances) cells.push_back({method, &row, 0, rtol});
      } else {
        for (const double h_omega : spaced(a.low, a.high, a.columns)) {
          cells.push_back({method, &row, h_omega, 0});
        }
      }
    }
  }
  return cells;
}

using Fates = std::vector<std::optional<RunOutcome>>;

Fates map_of(Study& study, const std::vector<Cell>& cells, const MapSettings& settings) {
  progress().begin(cells.size());
  return run_outcomes(study, cells, settings, [&](std::size_t count) {
    const auto left = static_cast<double>(cells.size() - count);
    progress().left_at_most(
        shared_seconds_at_most(left * settings.seconds, settings.seconds, omp_get_max_threads()));
    progress().finish("runs of the map");
  });
}

void tabulate(Csv& csv, const std::vector<Cell>& cells, const Fates& all) {
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

std::string or_none(double limit) {
  if (limit == 0) return "grows at every h";
  return std::isinf(limit) ? "none" : fmt::format("{:.10g}", limit);
}

void print(const std::vector<Limit>& limits) {
  fmt::print("{:<26} {:>18} {:>18} {:>12}\n", "limit of h w on an oscillator", "predicted",
             "measured", "difference");
  for (const Limit& limit : limits) {
    const double difference = limit.difference();
    fmt::print("{:<29} {:>18} {:>18} {:>12}\n", limit.method->name, or_none(limit.predicted),
               or_none(limit.measured),
               std::isfinite(difference) ? fmt::format("{:.1e}", difference) : "");
  }
}

// Prints the number of runs of each method by outcome.
void print(const std::vector<Cell>& cells, const Fates& all) {
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

// The scene at rest, or nothing, with the reason, if it has no rest.
std::optional<Scene> at_rest(const Scene& start, const std::string& source) {
  try {
    return settled(start, source);
  } catch (const InvalidInput& why) {
    progress().wipe();
    fmt::print(stderr, "stability_map: warning: {}; its modes are left out\n", why.what());
    return {};
  }
}

int stability_map(const CommandLine& line, const Arguments& a,
                  const std::vector<std::string>& command_line) {
  require_given(a.scene.name, "--scene", "a generator's name or a scene file");
  require(a);
  const Scene drawn = load(a.scene);
  const double until = end_time(a.until, line.has("--until"), drawn);
  if (line.has("--step-size")) require_step_size(a.step_size, "--step-size");
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  auto methods = select_methods(a.methods, scene, a.scene.name);
  progress().stage("finding the equilibrium");
  const std::optional<Scene> rest = at_rest(start, a.scene.name);
  progress().stage("finding the modes of the rows");
  const auto rows = rows_of(a, start, rest);
  Study study(line, a.out, {"limits.csv", "linear.csv", "adaptive.csv", "modal.csv", "map.csv"},
              {{"scene", content_hash(drawn)}, {"name", drawn.name}, {"until", until}},
              {.names = names_of(methods), .chosen_by = {"--methods"}});
  if (const auto status = study.completed()) return *status;
  std::erase_if(methods, [&](const Method* method) { return !study.takes(method->name); });
  CsvFile limits_csv(a.out + "/limits.csv",
                     {"method", "h_limit_predicted", "h_limit_measured", "h_omega_limit_predicted",
                      "h_omega_limit_measured", "relative_difference"});
  CsvFile linear_csv(a.out + "/linear.csv",
                     {"method", "h_omega", "spectral_radius", "damping_ratio", "period_error"});
  CsvFile adaptive_csv(
      a.out + "/adaptive.csv",
      {"method", "rtol", "omega_fast", "outcome", "h_omega_mean", "rejected_share", "energy_fast",
       "energy_error", "steps", "rejected", "stability_limited_steps"});
  CsvFile modal_csv(a.out + "/modal.csv", modal_columns());
  CsvFile map_csv(a.out + "/map.csv",
                  {"method", "h", "h_omega", "amplitude", "outcome", "growth_rate",
                   "predicted_growth_rate", "t_reached", "energy_end", "energy_max", "steps",
                   "rejected", "knob", "value", "omega_max", "buckling_rate"});

  const double omega_max = omega_max_of(scene);
  std::vector<Limit> limits;
  std::vector<Cell> cells;
  Fates all;
  study.measure([&] {
    add_limits(study, methods, limits);
    tabulate_linear(linear_csv, methods);
    tabulate_adaptive(study, adaptive_csv, methods);
    if (rest) {
      const ReducedScene at_rest(*rest, Reductions::all_directions());
      tabulate_modes(study, modal_csv, methods, at_rest, a.step_size);
    }
    cells = cells_of(a, followed(a, methods), rows);
    all = map_of(study, cells, {until, a.tolerated, a.cell_limit});
    if (std::ranges::any_of(all, [](const auto& result) { return !result; })) stop_if_interrupted();
  });
  if (study.is_share()) return study.conclude(done);
  tabulate(limits_csv, limits, omega_max);
  tabulate(map_csv, cells, all);

  nlohmann::json origin = provenance(command_line, drawn, start, scene);
  origin["until"] = until;
  origin["omega_max"] = omega_max;
  origin["tolerated"] = a.tolerated;
  origin["vary"] = a.vary;
  print(limits);
  print(cells, all);
  return study.finish({&limits_csv, &linear_csv, &adaptive_csv, &modal_csv, &map_csv}, origin,
                      done);
}

}  // namespace
}  // namespace qddot::stability_map

int main(int argc, char** argv) {
  using namespace qddot::stability_map;
  return qddot::kit::enter<Arguments>(
      {.name = "stability_map",
       .summary = "Measures where each method is stable, and compares with theory.",
       .has_resume = true,
       .has_shares = true},
      declare, stability_map, argc, argv);
}
