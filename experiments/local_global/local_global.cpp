// How much do iterations of local_global, of its accelerations and of Newton's method gain in one
// step of implicit Euler? The study repeats Figures 2 and 3 of Liu, Bargteil, O'Brien and Kavan
// (SIGGRAPH Asia 2013). It adds the step's own error. Iterations below that error gain nothing.
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
#include "experiments/local_global/cloth_runs.hpp"
#include "experiments/local_global/iterated_steps.hpp"

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::local_global;
  Program p("local_global",
            "Measures how much iterations gain in a step of implicit Euler, by several solvers.",
            {has_threads, has_resume});
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
    StepTables tables(p);
    auto& run = run_table(p);
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
      StepTables::add(table, cloth, setup);
    };
    return p.study(
        origin().at("scene"),
        [&](Study& study) {
          const auto runs = iterated_runs();
          progress().begin(1 + stiffnesses->size() + resolutions->size() + runs.size());
          const Comparison step = piece(study, "step", [&] {
            return compare(SwingingCloth(nodes, stiffness, swing), h, iterations, repeats, 0, true);
          });
          for (RowTable<StepRow>* table : {&tables.convergence, &tables.positions}) {
            StepTables::add(*table, step, step.setup);
            table->note({{"step_error", step.step_error}});
          }
          print(step, h);
          for (const std::string& failure : step.failures) say("local_global: " + failure);
          if (!step.failures.empty()) study.fall_short();

          nlohmann::json setups, setups_of_sizes;
          for (const double k : *stiffnesses)
            compare_cloth(study, tables.stiffness, "stiffness", k, nodes, k, setups);
          for (const int side : *resolutions) {
            compare_cloth(study, tables.resolution, "resolution", side, side,
                          stiffness * (side - 1) / (nodes - 1.0), setups_of_sizes);
          }

          fmt::print("\nruns of {:g} s with steps of {:g} s\n{:<24} {:>10} {:>9} {:>9} {:>9}\n",
                     *until, *h, "solver", "iterations", "s", "m off", "J lost");
          const SwingingCloth cloth(nodes, stiffness, 0);
          std::optional<State> exact;
          for (const auto& [method, n] : runs) {
            const std::string name = fmt::format("run {} {}", method->name, n);
            const RunRow row = piece(study, name, [&, by = method, iterations = n] {
              if (!exact) exact = cloth.truth(cloth.start, until);
              return measured_run(cloth, *exact, *by, iterations, h, until);
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
