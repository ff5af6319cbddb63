// How much do iterations of local_global, of its accelerations and of Newton's method gain in one
// step of implicit Euler? The study repeats Figures 2 and 3 of Liu, Bargteil, O'Brien and Kavan
// (SIGGRAPH Asia 2013) and adds the step's own error. Iterations below that error gain nothing.
//
//   local_global --out results/local_global
//   local_global --nodes 65 --stiffness 2400 --step-size 0.0333 --out results/coarse
//   local_global --speed --out results/speed
//
// The scene is a square cloth of 1 m and 1 kg, held at two corners, after --swing seconds of
// swinging. One step of --step-size follows, from the same state for all solvers. A row is a step
// with that many iterations, as `simulate --iterations` makes it, not an intermediate state of a
// longer iteration.
//
//  convergence.csv  (g(x_i) - g*) / (g(x_0) - g*) of the energy g that the step minimises, x_0 the
//                   inertial prediction. Seconds are without analysis and, if a solver's matrix is
//                   constant, without its one factorisation; the sidecar has both
//  positions.csv    the largest distance of a node to its place in the converged step, and the
//                   step's own error: the distance of the converged step to the true motion
//  stiffness.csv    convergence.csv for several stiffnesses
//  resolution.csv   and for several resolutions, with stiffness in proportion
//  run.csv          whole runs of --until: the error at the end and the energy lost
//  speed.csv        --speed alone: one iteration, set-up, and the assembly and factorisation of
//                   one of Newton's iterations, for 33, 65 and 101 nodes
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/pace.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/local_global/iterated_newton.hpp"
#include "experiments/local_global/iterated_steps.hpp"
#include "experiments/local_global/iteration_tables.hpp"
#include "experiments/local_global/swinging_cloth.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/algebra/laplacian_mass.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/duration.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::local_global {
namespace {

constexpr int standard_nodes = 33;
constexpr double standard_stiffness = 1200;
constexpr int speed_nodes[] = {33, 65, 101};
constexpr int most_iterations_of_figure_3 = 100;
constexpr double most_steps_of_run = 1e6;
constexpr std::array iterations_of_runs = {1, 2, 3, 5, 10, 20, 50, 100, 200};

struct Arguments {
  std::string out;
  int nodes = standard_nodes, iterations = 400, repeats = 5;
  double stiffness = standard_stiffness, step_size = 0.01, swing = 0.3, until = 0.5;
  std::vector<double> stiffnesses = {300, 600, 1200, 2400};
  std::vector<int> resolutions = {11, 21, 41, 81};
  bool speed = false;
};

void declare(CommandLine& line, Arguments& a) {
  line.add_option("--out", a.out, "the folder for the tables");
  line.add_option("--nodes", a.nodes, "number of nodes along a side of the cloth, 3 to 400")
      .capture_default_str();
  line.add_option("--stiffness", a.stiffness,
                  "stiffness of springs between neighbours in N/m; diagonals have half of it, "
                  "second neighbours a tenth")
      .capture_default_str();
  line.add_option("--step-size", a.step_size, "h in s").capture_default_str();
  line.add_option("--swing", a.swing, "the time that the cloth swings before the step in s")
      .capture_default_str();
  line.add_option("--until", a.until, "the time to run to in s, for run.csv").capture_default_str();
  line.add_option("--iterations", a.iterations, "the largest number of iterations, 1 to 100000")
      .capture_default_str();
  line.add_option(
          "--repeats", a.repeats,
          "timed runs of each step, of which the shortest counts, or the median with --speed")
      .capture_default_str();
  line.add_option("--stiffnesses", a.stiffnesses, "a,b,...: stiffnesses in N/m, for stiffness.csv")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--resolutions", a.resolutions,
                  "a,b,...: numbers of nodes along a side, for resolution.csv")
      .delimiter(',')
      .capture_default_str();
  line.add_flag("--speed", a.speed, "instead, time one iteration and the set-up, into speed.csv");
}

double median_of(int repeats, const auto& action) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) times.push_back(seconds_of(action));
  return median(std::move(times));
}

nlohmann::json origin_of(const std::vector<std::string>& command_line, const SwingingCloth& cloth,
                         const Arguments& a) {
  nlohmann::json origin = provenance(command_line, cloth.drawn, cloth.drawn, cloth.scene);
  origin["step_size"] = a.step_size;
  origin["swing"] = a.swing;
  origin["stiffness"] = a.stiffness;
  return origin;
}

nlohmann::json setups(const Comparison& comparison) {
  nlohmann::json setups;
  for (const Solved& solved : comparison.all) {
    setups[solved.method->name] = {{"analysis_s", solved.analysis},
                                   {"factorization_s", solved.factorization}};
  }
  return setups;
}

// One step by all solvers, for convergence.csv and positions.csv.
nlohmann::json compare_steps(const Arguments& a) {
  Csv convergence, positions;
  std::string lines;
  const auto print = [&](const std::string& line) { lines += line; };
  const SwingingCloth cloth(a.nodes, a.stiffness, a.swing);
  const Comparison comparison(cloth, a.step_size, a.iterations, a.repeats);
  const State exact = cloth.truth(cloth.start, a.step_size);
  const double own = cloth.distance(comparison.converged, exact);
  print(fmt::format("one step of {:g} s: {:.3g} m from the true motion when converged\n",
                    a.step_size, own));
  print(fmt::format("{:<24} {:>10} {:>9}  {}\n", "solver", "iterations", "ms",
                    "until no more than a tenth is added to that"));
  for (const Solved& solved : comparison.all) {
    const Step* first_good = nullptr;
    for (const Step& step : solved.steps) {
      const double distance = cloth.distance(step.end, comparison.converged);
      convergence.row(solved.method->name, step.iterations, step.seconds,
                      comparison.relative_error(step));
      positions.row(solved.method->name, step.iterations, step.seconds, distance, own);
      if (!first_good && distance <= own / 10) first_good = &step;
    }
    print(first_good ? fmt::format("{:<24} {:>10} {:>9.3f}\n", solved.method->name,
                                   first_good->iterations, 1e3 * first_good->seconds)
                     : fmt::format("{:<24} {:>10}\n", solved.method->name,
                                   fmt::format("> {}", solved.steps.back().iterations)));
  }
  std::vector<std::string> failures;
  for (const Solved& solved : comparison.all) {
    if (!solved.failure.empty()) failures.push_back(solved.failure);
  }
  return {{"convergence", convergence.text()},
          {"positions", positions.text()},
          {"lines", lines},
          {"failures", failures},
          {"setup", setups(comparison)},
          {"step_error", own}};
}

void write_step(Study& study, const Arguments& a, StepTables& tables) {
  const nlohmann::json step = study.piece("step", [&] { return compare_steps(a); });
  tables.convergence.rows(step.at("convergence").get<std::string>());
  tables.positions.rows(step.at("positions").get<std::string>());
  fmt::print("{}", step.at("lines").get<std::string>());
  for (const auto& failure : step.at("failures")) {
    fmt::print(stderr, "local_global: {}\n", failure.get<std::string>());
    tables.all_held = false;
  }
  tables.of_step = {{"setup", step.at("setup")}, {"step_error", step.at("step_error")}};
}

void write_figure_3(Study& study, const Arguments& a, StepTables& tables) {
  const auto add = [&](const char* table, CsvFile& csv, nlohmann::json& own, auto value, int nodes,
                       double stiffness) {
    const nlohmann::json piece = study.piece(fmt::format("{} {}", table, value), [&] {
      const SwingingCloth cloth(nodes, stiffness, a.swing);
      const Comparison comparison(cloth, a.step_size,
                                  std::min(a.iterations, most_iterations_of_figure_3), 1);
      Csv rows;
      for (const Solved& solved : comparison.all) {
        for (const Step& step : solved.steps) {
          rows.row(value, solved.method->name, step.iterations, step.seconds,
                   comparison.relative_error(step));
        }
      }
      return nlohmann::json{{"rows", rows.text()}, {"setup", setups(comparison)}};
    });
    csv.rows(piece.at("rows").get<std::string>());
    own["setup"][fmt::format("{:g}", static_cast<double>(value))] = piece.at("setup");
  };
  for (const double stiffness : a.stiffnesses)
    add("stiffness", tables.stiffness, tables.of_stiffness, stiffness, a.nodes, stiffness);
  for (const int nodes : a.resolutions) {
    add("resolution", tables.resolution, tables.of_resolution, nodes, nodes,
        a.stiffness * (nodes - 1) / static_cast<double>(a.nodes - 1));
  }
}

void write_run(Study& study, const Arguments& a, CsvFile& csv) {
  const SwingingCloth cloth(a.nodes, a.stiffness, 0);
  const double energy = total_energy(cloth.system(), cloth.start);
  std::optional<State> exact;
  fmt::print("\nruns of {:g} s with steps of {:g} s\n{:<24} {:>10} {:>9} {:>9} {:>9}\n", a.until,
             a.step_size, "solver", "iterations", "s", "m off", "J lost");
  const auto made = [&](const Method& method, int iterations) -> nlohmann::json {
    if (!exact) exact = cloth.truth(cloth.start, a.until);
    State end = cloth.start;
    Summary summary;
    const auto integrator = make_integrator(method, cloth.system(),
                                            {.step_size = a.step_size, .iterations = iterations});
    const double seconds = seconds_of(
        [&] { summary = integrator->advance(end, cloth.start.t + a.until, {}, interruption()); });
    if (summary.outcome != Outcome::reached_end) {
      return {{"rows", ""},
              {"line",
               fmt::format("{:<24} {:>10} {}\n", method.name, iterations, name(summary.outcome))}};
    }
    const double off = cloth.distance(end, *exact);
    const double change = total_energy(cloth.system(), end) - energy;
    Csv rows;
    rows.row(method.name, iterations, seconds, off, change);
    return {{"rows", rows.text()},
            {"line", fmt::format("{:<24} {:>10} {:>9.4f} {:>9.4f} {:>9.4f}\n", method.name,
                                 iterations, seconds, off, -change)}};
  };
  const auto add = [&](const Method& method, int iterations) {
    const nlohmann::json piece = study.piece(fmt::format("run {} {}", method.name, iterations),
                                             [&] { return made(method, iterations); });
    csv.rows(piece.at("rows").get<std::string>());
    fmt::print("{}", piece.at("line").get<std::string>());
  };
  for (const Method& method : methods()) {
    if (!method.listens_to(Option::iterations)) continue;
    for (const int iterations : iterations_of_runs) add(method, iterations);
  }
  for (const int iterations : {1, 2, 3, 5, 10, 20}) add(newton_clamped(), iterations);
  add(newton_exact(), most_newton_iterations);
}

// One iteration and what comes before the first, on a cloth of so many nodes along a side.
nlohmann::json measured_speed(const Arguments& a, int nodes) {
  const Method& method = *find_method("local_global");
  const double s = a.step_size * a.step_size;
  const SwingingCloth cloth(nodes, a.stiffness * (nodes - 1) / (standard_nodes - 1.0), 0);
  const System& system = cloth.system();
  constexpr int iterations = 10;
  const auto integrator = make_integrator(
      method, system, {.step_size = a.step_size, .iterations = iterations, .timed = true});
  std::vector<double> times;
  for (int i = 0; i < a.repeats; ++i) {
    State state = cloth.start;
    Summary summary;
    const double all = seconds_of([&] { summary = integrator->advance(state, a.step_size); });
    times.push_back((all - summary.seconds.factorization) / iterations);
  }
  const double setup = median_of(a.repeats, [&] {
    LaplacianMass matrix(system);
    matrix.factorize(s);
  });
  EffectiveMass newton(system);
  SymmetricMatrix k = system.stiffness_pattern();
  const double factorization = median_of(a.repeats, [&] {
    system.stiffness(cloth.start.q, k);
    newton.factorize_positive(1, s, k);
  });
  const double iteration = median(std::move(times));
  Csv rows;
  rows.row(nodes, cloth.drawn.springs.size(), iteration, setup, factorization);
  return {{"rows", rows.text()},
          {"line", fmt::format("{:>6} {:>8} {:>13.4f} {:>10.3f} {:>17.3f}\n", nodes,
                               cloth.drawn.springs.size(), 1e3 * iteration, 1e3 * setup,
                               1e3 * factorization)}};
}

// Throws InvalidInput for what would take steps without end; says on stderr what takes more than a
// minute.
void require_affordable(const Arguments& a) {
  const double steps = a.until / a.step_size;
  if (!(steps <= most_steps_of_run)) {
    throw InvalidInput(fmt::format(
        "--step-size {:g}: the runs of {:g} s (--until) are {:.3g} steps; allowed are up to {:g}",
        a.step_size, a.until, steps, most_steps_of_run));
  }
  require_reachable(a.nodes, a.stiffness, a.step_size, "--step-size");
  require_reachable(a.nodes, a.stiffness, a.until, "--until");
  double sizes = 0;
  for (const double stiffness : a.stiffnesses) {
    require_reachable(a.nodes, stiffness, a.swing, "--swing");
    sizes += 1;
  }
  for (const int nodes : a.resolutions) {
    const double part = (nodes - 1) / static_cast<double>(a.nodes - 1);
    require_reachable(nodes, a.stiffness * part, a.swing, "--swing");
    sizes += part * part;
  }
  double of_runs = 0;
  for (const int iterations : iterations_of_runs) of_runs += 4 * iterations;
  const double iterations =
      iterations_of_comparison(a.iterations, a.repeats) +
      sizes * iterations_of_comparison(std::min(a.iterations, most_iterations_of_figure_3), 1) +
      steps * of_runs;
  const double seconds =
      seconds_of_iterations(SwingingCloth(a.nodes, a.stiffness, 0), a.step_size, iterations);
  if (seconds > 60)
    fmt::print(stderr, "local_global: this takes about {}\n", duration_in_words(seconds));
}

int measure_speed(const CommandLine& line, const Arguments& a, const nlohmann::json& origin) {
  Study study(line, a.out, {"speed.csv"}, origin.at("scene"));
  if (const auto status = study.completed()) return *status;
  CsvFile csv(a.out + "/speed.csv",
              {"nodes", "springs", "iteration_s", "setup_s", "factorization_s"});
  study.measure([&] {
    fmt::print("{:>6} {:>8} {:>13} {:>10} {:>17}\n", "nodes", "springs", "iteration ms",
               "set-up ms", "factorisation ms");
    for (const int nodes : speed_nodes) {
      const nlohmann::json piece =
          study.piece(fmt::format("speed {}", nodes), [&] { return measured_speed(a, nodes); });
      csv.rows(piece.at("rows").get<std::string>());
      fmt::print("{}", piece.at("line").get<std::string>());
    }
  });
  return study.finish({&csv}, origin, done);
}

int measure_steps(const CommandLine& line, const Arguments& a, const nlohmann::json& origin) {
  Study study(line, a.out, StepTables::names(), origin.at("scene"));
  if (const auto status = study.completed()) return *status;
  StepTables tables(a.out);
  study.measure([&] {
    write_step(study, a, tables);
    write_figure_3(study, a, tables);
    write_run(study, a, tables.run);
  });
  const ExitStatus status = tables.all_held ? done : end_not_reached;
  const auto commit = [&](CsvFile& table, const nlohmann::json& own) {
    nlohmann::json whole = origin;
    whole.update(own);
    study.complete(table, whole, status);
  };
  commit(tables.convergence, tables.of_step);
  commit(tables.positions, tables.of_step);
  commit(tables.stiffness, tables.of_stiffness);
  commit(tables.resolution, tables.of_resolution);
  commit(tables.run, nlohmann::json::object());
  return study.conclude(status);
}

int local_global_program(const CommandLine& line, const Arguments& a,
                         const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  require_within(a.nodes, 3, 400, "--nodes");
  for (const int nodes : a.resolutions) require_within(nodes, 3, 400, "--resolutions");
  for (const double stiffness : a.stiffnesses) {
    require_positive(stiffness, "--stiffnesses", "a stiffness in N/m");
  }
  require_within(a.iterations, 1, 100000, "--iterations");
  require_repeats(a.repeats);
  require_positive(a.stiffness, "--stiffness", "a stiffness in N/m");
  require_positive(a.until, "--until", "the length of the runs in s");
  if (!(std::isfinite(a.swing) && a.swing >= 0)) {
    throw InvalidInput(fmt::format(
        "--swing {} is not allowed; it is a time in s, finite and at least 0", a.swing));
  }
  require_step_size(a.step_size, "--step-size", a.swing + a.until);
  if (!a.speed) require_affordable(a);
  require_folder(a.out);
  const SwingingCloth cloth(a.speed ? standard_nodes : a.nodes, a.stiffness, 0);
  const nlohmann::json origin = origin_of(command_line, cloth, a);
  return a.speed ? measure_speed(line, a, origin) : measure_steps(line, a, origin);
}

}  // namespace
}  // namespace qddot::local_global

int main(int argc, char** argv) {
  using namespace qddot::local_global;
  return qddot::kit::enter<Arguments>(
      {.name = "local_global",
       .summary =
           "Measures how much iterations gain in a step of implicit Euler, by several solvers.",
       .has_threads = true,
       .has_resume = true},
      declare, local_global_program, argc, argv);
}
