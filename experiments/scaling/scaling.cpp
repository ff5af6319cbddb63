// How does the cost of a step grow with the number of nodes? Each phase of a step is compared with
// theory and with the limits of the machine.
//
//   scaling --out results/scaling
//   scaling --scenes lattice --methods semi_implicit_euler --most-nodes 3e4 --out results/lattice
//
// Each scene is drawn at 1e2 to 1e6 nodes, three sizes a decade. It is reduced, but not by its
// symmetries (--no-reduce), so that all n nodes remain. The step of explicit methods is half of the
// certainly stable one, 1/w for a bound w of w_max; that of implicit ones is --step-size. A size is
// left out, with a message, if theory and the size before predict more than --point-limit or
// --memory-limit.
//
//  scaling.csv    seconds and bytes of each phase:
//                 scene, reduce        once; what they leave allocated
//                 symbolic             once: the order of elimination and the memory of the factors
//                 force, stiffness, factorization, solve, rest, and their sum step
//                                      of a step, on the mean; bytes of K, of the factors alone,
//                                      and of all that the method allocates
//                 preconditioner, iterations
//                                      of conjugate gradients, in place of factorization and solve
//  exponents.csv  p of seconds = c nodes^p over the last one and a half decades, with its interval
//                 of 95 % and what theory gives at the same sizes; `fill` is of the factors' bytes
//  roofline.csv   evaluations of f alone; the triad's bandwidth over arrays of the same size, and
//                 the peak of multiplications and additions
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/memory.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/scaling/phase_table.hpp"
#include "experiments/scaling/scaling_run.hpp"
#include "qddot/measure/speed/machine_limits.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::scaling {
namespace {

constexpr double gigabyte = 1e9;
constexpr double least_nodes_allowed = 10, most_nodes_allowed = 1e7;
// The time [s] in which the peak is measured.
constexpr double look_for_peak = 0.05;
// The fraction of free memory that is used by default.
constexpr double taken_of_free = 0.8;

struct Arguments {
  std::vector<std::string> scenes = {"chain", "cloth", "lattice"};
  std::vector<std::string> methods = {"verlet", "semi_implicit_euler"};
  std::vector<std::string> solvers = {"multifrontal", "conjugate_gradients"};
  SceneChoice choice{.name = {}, .no_reduce = {"dimension", "mirror"}};
  double least_nodes = 1e2, most_nodes = 1e6, point_limit = 30, memory_limit = 0, step_size = 1e-3;
  int sizes = 3;
  std::string out;
};

void declare(CommandLine& line, Arguments& a) {
  line.add_option("--scenes", a.scenes, "a,b,...: the scenes, of chain, cloth and lattice")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--methods", a.methods, "a,b,...: the methods, of fixed steps")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--solvers", a.solvers,
                  fmt::format("a,b,...: the solvers of implicit methods, of {}", solver_list()))
      .delimiter(',')
      .capture_default_str();
  line.add_option("--least-nodes", a.least_nodes,
                  "approximate number of nodes of the smallest scene")
      .capture_default_str();
  line.add_option("--most-nodes", a.most_nodes, "approximate number of nodes of the largest scene")
      .capture_default_str();
  line.add_option("--sizes", a.sizes, "number of sizes per decade").capture_default_str();
  line.add_option("--step-size", a.step_size, "the step size h of implicit methods in s")
      .capture_default_str();
  line.add_option("--point-limit", a.point_limit,
                  "seconds that a step and its analysis may take; larger scenes are left out")
      .capture_default_str();
  line.add_option("--memory-limit", a.memory_limit,
                  "GB that a scene and a method may take (default: 0.8 of the free memory)");
  line.add_option("--no-reduce", a.choice.no_reduce,
                  "a,b,...: reductions of the scenes to leave out")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--out", a.out, "the folder for the tables");
}

void require_options(const CommandLine& line, const Arguments& a) {
  require_given(a.out, "--out", "the folder for the results");
  require_step_size(a.step_size, "--step-size");
  require_positive(a.point_limit, "--point-limit", "the seconds a step may take");
  require_within(a.sizes, 1, 20, "--sizes");
  if (line.has("--memory-limit")) {
    require_positive(a.memory_limit, "--memory-limit", "the memory to take in GB");
  }
  for (const auto& [value, option] :
       {std::pair(a.least_nodes, "--least-nodes"), std::pair(a.most_nodes, "--most-nodes")}) {
    if (value >= least_nodes_allowed && value <= most_nodes_allowed) continue;
    throw InvalidInput(fmt::format("{} {} is not allowed; it is a number from {} to {:g}", option,
                                   value, least_nodes_allowed, most_nodes_allowed));
  }
  if (a.least_nodes > a.most_nodes) {
    throw InvalidInput(
        fmt::format("--least-nodes {} is more than --most-nodes {}", a.least_nodes, a.most_nodes));
  }
  std::set<std::string> seen;
  for (const std::string& name : a.scenes) {
    find_sized_scenes(name);
    if (!seen.insert(name).second)
      throw InvalidInput(fmt::format("--scenes: {} is named twice; allowed is once", name));
  }
}

std::vector<Solver> select_solvers(const std::vector<std::string>& names) {
  std::vector<Solver> solvers;
  for (const std::string& name : names) {
    const auto solver = find_solver(name);
    if (!solver) {
      throw InvalidInput(
          fmt::format("--solvers: {} is not a solver; allowed are {}", name, solver_list()));
    }
    if (std::ranges::count(solvers, *solver) > 0)
      throw InvalidInput(fmt::format("--solvers: {} is named twice; allowed is once", name));
    solvers.push_back(*solver);
  }
  return solvers;
}

// The methods, each with all solvers if it uses one. All have fixed steps and can run the scene.
std::vector<SolvedMethod> select(const SizedScenes& scenes, const Arguments& a) {
  const ReducedScene smallest(scenes.draw(least_nodes_allowed), reductions_of(a.choice));
  const auto solvers = select_solvers(a.solvers);
  std::vector<SolvedMethod> selected;
  for (const Method* method : select_methods(a.methods, smallest, scenes.name)) {
    if (method->knob != Knob::step_size) {
      throw InvalidInput(fmt::format(
          "--methods: {} chooses its steps by itself; allowed are methods of fixed step",
          method->name));
    }
    if (!method->listens_to(Option::solver)) {
      selected.push_back({method, Solver::multifrontal});
      continue;
    }
    for (const Solver solver : solvers) selected.push_back({method, solver});
  }
  return selected;
}

// Sizes from the least to the most nodes, both included, `sizes` for each decade.
std::vector<double> sizes_of(const Arguments& a) {
  std::vector<double> sizes;
  const double step = 1.0 / a.sizes;
  for (int i = 0;; ++i) {
    const double size = a.least_nodes * std::pow(10, i * step);
    if (size > a.most_nodes * std::pow(10, -step / 2)) break;
    sizes.push_back(size);
  }
  sizes.push_back(a.most_nodes);
  return sizes;
}

void write_costs(Csv& csv, const ScalingRun& run) {
  for (const PhaseCost& c : run.costs())
    csv.row(c.scene, c.nodes, c.springs, c.method, c.phase, c.seconds, c.bytes);
}

void write_exponents(Csv& csv, const ScalingRun& run) {
  fmt::print("\n{:<8} {:<20} {:<14} {:>8}   {:<14} {:>6}\n", "scene", "method", "phase", "exponent",
             "95 %", "theory");
  for (const auto& [scene, method, phase, fit, theory, from, to] : exponents_of(run.costs())) {
    csv.row(scene, method, phase, fit.exponent, fit.low, fit.high, theory, from, to);
    fmt::print("{:<8} {:<20} {:<14} {:>8.2f}   {:.2f} to {:.2f}   {:>6.2f}\n", scene, method, phase,
               fit.exponent, fit.low, fit.high, theory);
  }
}

void write_roofline(Csv& csv, const ScalingRun& run, double peak) {
  fmt::print("\nf: {:.3g} GFlop/s is the peak\n{:<8} {:>9} {:>12} {:>8} {:>8} {:>8}\n", 1e-9 * peak,
             "scene", "nodes", "M springs/s", "GB/s", "triad", "GFlop/s");
  for (const ScalingSize& size : run.sizes()) {
    const auto& [seconds, bytes, flops] = size.force;
    csv.row(size.scene, size.nodes, size.springs, seconds, size.springs / seconds,
            bytes / size.springs, flops / size.springs, bytes, size.triad, peak);
    fmt::print("{:<8} {:>9} {:>12.4g} {:>8.3g} {:>8.3g} {:>8.3g}\n", size.scene, size.nodes,
               1e-6 * size.springs / seconds, 1e-9 * bytes / seconds, 1e-9 * size.triad,
               1e-9 * flops / seconds);
  }
}

nlohmann::json origin_of(const std::vector<std::string>& command_line, const Arguments& a,
                         const ScalingRun& run) {
  nlohmann::json origin =
      provenance(command_line, find_sized_scenes(a.scenes.front()).draw(least_nodes_allowed));
  origin.erase("scene");
  origin["scenes"] = nlohmann::json::array();
  for (const ScalingSize& size : run.sizes()) {
    origin["scenes"].push_back({{"name", size.scene},
                                {"hash", size.hash},
                                {"nodes", size.nodes},
                                {"springs", size.springs},
                                {"unknowns", size.unknowns}});
  }
  origin["left_out"] = nlohmann::json::array();
  for (const auto& [scene, method, nodes, why] : run.left_out()) {
    origin["left_out"].push_back(
        {{"scene", scene}, {"method", method}, {"nodes", nodes}, {"why", why}});
  }
  origin["step_size"] = a.step_size;
  origin["no_reduce"] = a.choice.no_reduce;
  return origin;
}

int scaling(const CommandLine& line, const Arguments& a,
            const std::vector<std::string>& command_line) {
  require_options(line, a);
  std::vector<std::vector<SolvedMethod>> methods;
  for (const std::string& name : a.scenes) methods.push_back(select(find_sized_scenes(name), a));
  require_folder(a.out);
  Study study(line, a.out, {"scaling.csv", "exponents.csv", "roofline.csv"}, {});
  if (const auto status = study.completed()) return *status;
  CsvFile costs(a.out + "/scaling.csv",
                {"scene", "nodes", "springs", "method", "phase", "seconds", "bytes"});
  CsvFile exponents(a.out + "/exponents.csv", {"scene", "method", "phase", "exponent", "low",
                                               "high", "theory", "nodes_from", "nodes_to"});
  CsvFile roofline(
      a.out + "/roofline.csv",
      {"scene", "nodes", "springs", "seconds", "springs_per_second", "bytes_per_spring",
       "flops_per_spring", "working_set_bytes", "triad_bytes_per_second", "peak_flops_per_second"});
  const bool is_told = line.has("--memory-limit");
  ScalingRun run({.seconds = a.point_limit,
                  .bytes = is_told ? gigabyte * a.memory_limit : taken_of_free * free_memory(),
                  .step_size = a.step_size,
                  .reductions = reductions_of(a.choice)});
  study.measure([&] {
    for (std::size_t i = 0; i < a.scenes.size(); ++i)
      run.measure(study, find_sized_scenes(a.scenes[i]), sizes_of(a), methods[i]);
  });

  const double peak = peak_flops(look_for_peak);
  write_costs(costs, run);
  write_exponents(exponents, run);
  write_roofline(roofline, run, peak);
  for (const auto& [scene, method, nodes, why] : run.left_out()) {
    fmt::print("left out: {}{}{} from {:.0f} nodes on: {}\n", scene, method.empty() ? "" : " with ",
               method, nodes, why);
  }
  const nlohmann::json origin = origin_of(command_line, a, run);
  return study.finish({&costs, &exponents, &roofline}, origin,
                      run.has_failed() ? end_not_reached : done);
}

}  // namespace
}  // namespace qddot::scaling

int main(int argc, char** argv) {
  using namespace qddot::scaling;
  return qddot::kit::enter<Arguments>(
      {.name = "scaling",
       .summary = "Measures how the cost of a step grows with the number of nodes.",
       .has_threads = true,
       .has_resume = true},
      declare, scaling, argc, argv);
}
