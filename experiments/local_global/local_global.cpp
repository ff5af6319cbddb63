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
#include <optional>

#include <fmt/format.h>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/local_global/iterated_steps.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/algebra/laplacian_mass.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::local_global {
namespace {

constexpr int standard_nodes = 33;  // along a side

// A whole run of the cloth by steps of so many iterations.
struct RunRow {
  std::string solver;
  int iterations = 0;
  Outcome outcome{};
  double seconds = 0, position_error = 0, energy_change = 0;  // [s], [m], [J]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunRow, solver, iterations, outcome, seconds, position_error,
                                   energy_change)

// Steps of h [s] over `until` [s]; `exact` is where the true motion then is.
RunRow measured_run(const SwingingCloth& cloth, const State& exact, const Method& method,
                    int iterations, double h, double until) {
  State end = cloth.start;
  Summary summary;
  const auto integrator =
      make_integrator(method, cloth.system(), {.step_size = h, .iterations = iterations});
  const double seconds = seconds_of(
      [&] { summary = integrator->advance(end, cloth.start.t + until, {}, interruption()); });
  return {method.name,
          iterations,
          summary.outcome,
          seconds,
          cloth.distance(end, exact),
          total_energy(cloth.system(), end) - total_energy(cloth.system(), cloth.start)};
}

// The methods of these runs, with the numbers of their iterations.
std::vector<std::pair<const Method*, int>> iterated_runs() {
  std::vector<std::pair<const Method*, int>> runs;
  for (const Method& method : methods()) {
    if (!method.listens_to(Option::iterations)) continue;
    for (const int n : {1, 2, 3, 5, 10, 20, 50, 100, 200}) runs.emplace_back(&method, n);
  }
  for (const int n : {1, 2, 3, 5, 10, 20}) runs.emplace_back(&newton_clamped(), n);
  runs.emplace_back(&newton_exact(), most_newton_iterations);
  return runs;
}

void print(const RunRow& run) {
  fmt::print("{:<24} {:>10} ", run.solver, run.iterations);
  if (run.outcome != Outcome::reached_end) {
    fmt::print("{}\n", name(run.outcome));
  } else {
    fmt::print("{:>9.4f} {:>9.4f} {:>9.4f}\n", run.seconds, run.position_error, -run.energy_change);
  }
}

// A row of speed.csv.
struct SpeedRow {
  int nodes = 0;
  std::size_t springs = 0;
  double iteration = 0, setup = 0, factorization = 0;  // [s]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SpeedRow, nodes, springs, iteration, setup, factorization)

SpeedRow measured_speed(int nodes, double stiffness, double h, int repeats) {
  const SwingingCloth cloth(nodes, stiffness, 0);
  constexpr int iterations = 10;
  const System& system = cloth.system();
  const auto median_of = [&](const auto& seconds) {
    std::vector<double> times;
    for (int i = 0; i < repeats; ++i) times.push_back(seconds());
    return median(std::move(times));
  };
  const auto integrator =
      make_integrator(*find_method("local_global"), system,
                      {.step_size = h, .iterations = iterations, .timed = true});
  const double iteration = median_of([&] {
    State state = cloth.start;
    Summary summary;
    const double all = seconds_of([&] { summary = integrator->advance(state, h); });
    return (all - summary.seconds.factorization) / iterations;
  });
  const double setup =
      median_of([&] { return seconds_of([&] { LaplacianMass(system).factorize(h * h); }); });
  EffectiveMass newton(system);
  SymmetricMatrix k = system.stiffness_pattern();
  const double factorization = median_of([&] {
    return seconds_of([&] {
      system.stiffness(cloth.start.q, k);
      newton.factorize_positive(1, h * h, k);
    });
  });
  return {nodes, cloth.drawn.springs.size(), iteration, setup, factorization};
}

// Writes speed.csv: what local_global takes for one iteration and before the first one, and one of
// Newton's iterations to assemble and factorise its matrix. They are medians of `repeats`
// measurements, with steps of h [s], of cloths of 33, 65 and 101 nodes along a side whose stiffness
// [N/m] grows in proportion. Returns the exit status.
int time_iterations(Program& p, double stiffness, double h, int repeats,
                    const nlohmann::json& origin) {
  auto& table = p.table<SpeedRow>("speed.csv", {{"nodes", &SpeedRow::nodes},
                                                {"springs", &SpeedRow::springs},
                                                {"iteration_s", &SpeedRow::iteration},
                                                {"setup_s", &SpeedRow::setup},
                                                {"factorization_s", &SpeedRow::factorization}});
  return p.study(
      origin.at("scene"),
      [&](Study& study) {
        fmt::print("{:>6} {:>8} {:>13} {:>10} {:>17}\n", "nodes", "springs", "iteration ms",
                   "set-up ms", "factorisation ms");
        for (const int nodes : {standard_nodes, 65, 101}) {
          const double k = stiffness * (nodes - 1) / (standard_nodes - 1.0);
          const SpeedRow row = study.piece(fmt::format("speed {}", nodes), [&] {
            return nlohmann::json(measured_speed(nodes, k, h, repeats));
          });
          table.add(row);
          fmt::print("{:>6} {:>8} {:>13.4f} {:>10.3f} {:>17.3f}\n", row.nodes, row.springs,
                     1e3 * row.iteration, 1e3 * row.setup, 1e3 * row.factorization);
        }
      },
      [&] { return origin; });
}

}  // namespace
}  // namespace qddot::local_global

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::local_global;
  Program p(
      {.name = "local_global",
       .summary =
           "Measures how much iterations gain in a step of implicit Euler, by several solvers.",
       .has_threads = true,
       .has_resume = true});
  p.out("the folder for the tables");
  const auto is_side = [](int n, const std::string& option) { require_within(n, 3, 400, option); };
  const auto is_stiffness = [](double k, const std::string& option) {
    require_positive(k, option, "a stiffness in N/m");
  };
  auto nodes =
      p.whole("--nodes", standard_nodes, "number of nodes along a side of the cloth, 3 to 400")
          .check(is_side);
  auto stiffness = p.number("--stiffness", 1200,
                            "stiffness of springs between neighbours in N/m; diagonals have half "
                            "of it, second neighbours a tenth")
                       .check(is_stiffness);
  auto h = p.number("--step-size", 0.01, "h in s");
  auto swing = p.number("--swing", 0.3, "the time that the cloth swings before the step in s")
                   .check(require_swing);
  auto until = p.number("--until", 0.5, "the time to run to in s, for run.csv")
                   .positive("the length of the runs in s");
  auto iterations = p.whole("--iterations", 400, "the largest number of iterations, 1 to 100000")
                        .within(1, 100000);
  auto repeats =
      p.whole("--repeats", 5,
              "timed runs of each step, of which the shortest counts, or the median with --speed")
          .within(1, 1000);
  auto stiffnesses = p.numbers("--stiffnesses", {300, 600, 1200, 2400},
                               "a,b,...: stiffnesses in N/m, for stiffness.csv")
                         .check_each(is_stiffness);
  auto resolutions = p.wholes("--resolutions", {11, 21, 41, 81},
                              "a,b,...: numbers of nodes along a side, for resolution.csv")
                         .check_each(is_side);
  auto speed = p.flag("--speed", "instead, time one iteration and the set-up, into speed.csv");

  const auto origin = [&] {
    const SwingingCloth cloth(speed ? standard_nodes : *nodes, stiffness, 0);
    nlohmann::json json = provenance(p.command_line(), cloth.drawn, cloth.drawn, cloth.scene);
    json.update({{"step_size", *h}, {"swing", *swing}, {"stiffness", *stiffness}});
    return json;
  };
  const auto measure_steps = [&] {
    const auto step_table = [&](const std::string& file, const std::string& varied,
                                const Columns<StepRow>& last) -> RowTable<StepRow>& {
      Columns<StepRow> columns = {};
      if (!varied.empty()) columns += {{varied, &StepRow::varied}};
      columns += {{"solver", &StepRow::solver},
                  {"iteration", &StepRow::iteration},
                  {"seconds", &StepRow::seconds}};
      columns += last;
      return p.table(file, columns);
    };
    const Columns<StepRow> error = {{"relative_error", &StepRow::relative_error}};
    auto& convergence = step_table("convergence.csv", "", error);
    auto& positions =
        step_table("positions.csv", "",
                   {{"distance_to_converged", &StepRow::distance}, {"step_error", &StepRow::own}});
    auto& by_stiffness = step_table("stiffness.csv", "stiffness", error);
    auto& by_resolution = step_table("resolution.csv", "nodes", error);
    auto& run = p.table<RunRow>("run.csv", {{"solver", &RunRow::solver},
                                            {"iterations", &RunRow::iterations},
                                            {"seconds", &RunRow::seconds},
                                            {"position_error", &RunRow::position_error},
                                            {"energy_change", &RunRow::energy_change}});
    // Adds one step of one cloth to a table, and its setup to the table's sidecar.
    const auto add = [](RowTable<StepRow>& table, const Comparison& step,
                        const nlohmann::json& setup) {
      for (const StepRow& row : step.rows) table.add(row);
      table.note({{"setup", setup}});
    };
    const auto piece = [](Study& study, const std::string& name, const auto& make) {
      progress().now_at(name);
      const nlohmann::json made = study.piece(name, [&] { return nlohmann::json(make()); });
      progress().finish(name);
      progress().wipe();
      return made;
    };
    const auto compare_cloth = [&](Study& study, RowTable<StepRow>& table, const char* varied,
                                   double value, int side, double k, nlohmann::json& setup) {
      constexpr int most = 100;
      const Comparison cloth = piece(study, fmt::format("{} {}", varied, value), [&] {
        return compare(SwingingCloth(side, k, swing), h, std::min(*iterations, most), 1, value,
                       false);
      });
      setup[fmt::format("{:g}", value)] = cloth.setup;
      add(table, cloth, setup);
    };
    return p.study(
        origin().at("scene"),
        [&](Study& study) {
          const auto runs = iterated_runs();
          progress().begin(1 + stiffnesses->size() + resolutions->size() + runs.size());
          const Comparison step = piece(study, "step", [&] {
            return compare(SwingingCloth(nodes, stiffness, swing), h, iterations, repeats, 0, true);
          });
          for (RowTable<StepRow>* table : {&convergence, &positions}) {
            add(*table, step, step.setup);
            table->note({{"step_error", step.step_error}});
          }
          print(step, h);
          for (const std::string& failure : step.failures) say("local_global: " + failure);
          if (!step.failures.empty()) study.fall_short();

          nlohmann::json setups, setups_of_sizes;
          for (const double k : *stiffnesses)
            compare_cloth(study, by_stiffness, "stiffness", k, nodes, k, setups);
          for (const int side : *resolutions) {
            compare_cloth(study, by_resolution, "resolution", side, side,
                          stiffness * (side - 1) / (nodes - 1.0), setups_of_sizes);
          }

          fmt::print("\nruns of {:g} s with steps of {:g} s\n{:<24} {:>10} {:>9} {:>9} {:>9}\n",
                     *until, *h, "solver", "iterations", "s", "m off", "J lost");
          const SwingingCloth cloth(nodes, stiffness, 0);
          std::optional<State> exact;
          for (const auto& [method, n] : runs) {
            const RunRow row = piece(study, fmt::format("run {} {}", method->name, n), [&] {
              if (!exact) exact = cloth.truth(cloth.start, until);
              return measured_run(cloth, *exact, *method, n, h, until);
            });
            if (row.outcome == Outcome::reached_end) run.add(row);
            print(row);
          }
        },
        origin);
  };
  return p.run(argc, argv, [&] {
    require_step_size(h, "--step-size", swing + until);
    if (speed) return time_iterations(p, stiffness, h, repeats, origin());
    require_affordable(nodes, stiffness, h, until);
    for (const double k : *stiffnesses) require_reachable(nodes, k, swing, "--swing");
    for (const int side : *resolutions)
      require_reachable(side, stiffness * (side - 1) / (nodes - 1.0), swing, "--swing");
    return measure_steps();
  });
}
