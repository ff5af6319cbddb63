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
#include <vector>

#include <fmt/format.h>

#include "experiments/kit/memory.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/scaling/scaling_tables.hpp"
#include "qddot/measure/speed/machine_limits.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::scaling {
namespace {

constexpr double gigabyte = 1e9;
constexpr double taken_of_free = 0.8;   // the fraction of free memory that is used by default
constexpr double look_for_peak = 0.05;  // the time [s] in which the peak is measured

void require_nodes(double nodes, const std::string& option) {
  if (nodes >= least_nodes && nodes <= most_nodes) return;
  throw InvalidInput(fmt::format("{} {} is not allowed; it is a number from {} to {:g}", option,
                                 nodes, least_nodes, most_nodes));
}

// Adds the scenes that were measured, and what was not, to the record of the tables.
nlohmann::json noted(nlohmann::json origin, const ScalingResults& results) {
  origin["scenes"] = nlohmann::json::array();
  for (const ScalingSize& size : results.sizes) {
    origin["scenes"].push_back({{"name", size.scene},
                                {"hash", size.hash},
                                {"nodes", size.nodes},
                                {"springs", size.springs},
                                {"unknowns", size.unknowns}});
  }
  origin["left_out"] = results.left_out;
  return origin;
}

}  // namespace
}  // namespace qddot::scaling

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::scaling;
  Program p("scaling", "Measures how the cost of a step grows with the number of nodes.",
            {has_threads, has_resume});
  auto names =
      p.words("--scenes", {"chain", "cloth", "lattice"},
              "a,b,...: the scenes, of chain, cloth and lattice")
          .check_each([](const std::string& name, const std::string&) { find_sized_scenes(name); })
          .check(require_each_once<std::string>);
  auto methods = p.words("--methods", {"verlet", "semi_implicit_euler"},
                         "a,b,...: the methods, of fixed steps");
  auto solvers =
      p.words("--solvers", {"multifrontal", "conjugate_gradients"},
              fmt::format("a,b,...: the solvers of implicit methods, of {}", solver_list()))
          .check(require_each_once<std::string>);
  auto least = p.number("--least-nodes", 1e2, "approximate number of nodes of the smallest scene")
                   .check(require_nodes);
  auto most = p.number("--most-nodes", 1e6, "approximate number of nodes of the largest scene")
                  .check(require_nodes);
  auto sizes = p.whole("--sizes", 3, "number of sizes per decade").within(1, 20);
  auto step_size =
      p.number("--step-size", 1e-3, "the step size h of implicit methods in s")
          .check([](double h, const std::string& option) { require_step_size(h, option); });
  auto limit = p.number("--point-limit", 30,
                        "seconds that a step and its analysis may take; larger scenes are left out")
                   .positive("the seconds a step may take");
  auto memory = p.number("--memory-limit",
                         "GB that a scene and a method may take (default: 0.8 of the free memory)")
                    .positive("the memory to take in GB");
  auto no_reduce = p.words("--no-reduce", {"dimension", "mirror"},
                           "a,b,...: reductions of the scenes to leave out");
  p.out("the folder for the tables");
  auto& costs =
      p.table("scaling.csv", {"scene", "nodes", "springs", "method", "phase", "seconds", "bytes"});
  auto& exponents = p.table("exponents.csv", {"scene", "method", "phase", "exponent", "low", "high",
                                              "theory", "nodes_from", "nodes_to"});
  auto& roofline =
      p.table("roofline.csv", {"scene", "nodes", "springs", "seconds", "springs_per_second",
                               "bytes_per_spring", "flops_per_spring", "working_set_bytes",
                               "triad_bytes_per_second", "peak_flops_per_second"});

  return p.run(argc, argv, [&] {
    if (least > most)
      throw InvalidInput(
          fmt::format("--least-nodes {} is more than --most-nodes {}", *least, *most));
    const Reductions reductions = reductions_of({.name = {}, .no_reduce = *no_reduce});
    std::vector<std::vector<SolvedMethod>> solved;
    for (const std::string& name : *names)
      solved.push_back(solved_methods(find_sized_scenes(name), reductions, methods, solvers));
    ScalingRun run({.seconds = limit,
                    .bytes = memory.is_given() ? gigabyte * memory : taken_of_free * free_memory(),
                    .step_size = step_size,
                    .reductions = reductions});
    return p.study(
        {},
        [&](Study& study) {
          for (std::size_t i = 0; i < names->size(); ++i) {
            run.measure(study, find_sized_scenes((*names)[i]), sizes_between(least, most, sizes),
                        solved[i]);
          }
          if (run.results().has_failed) study.fall_short();
        },
        [&] {
          const ScalingResults& results = run.results();
          write_tables(results, peak_flops(look_for_peak), *costs, *exponents, *roofline);
          nlohmann::json origin = noted(p.origin(), results);
          origin["step_size"] = *step_size;
          origin["no_reduce"] = *no_reduce;
          return origin;
        });
  });
}
