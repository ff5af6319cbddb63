// Where a scene comes to rest: a stable minimum of its potential energy, downhill from the drawn
// positions.
//
//   equilibrium --scene cloth --final rest.csv
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/node_table.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::equilibrium {
namespace {

struct Arguments {
  std::string scene, final_path;
};

void declare(CommandLine& line, Arguments& a) {
  line.add_option("--scene", a.scene, "a generator's name or a scene file");
  line.add_option("--final", a.final_path,
                  "CSV of all nodes at rest (or, with status 3, where the search ended), with "
                  "velocities of zero: node,x,y,z,vx,vy,vz");
}

int equilibrium(const CommandLine& line, const Arguments& a,
                const std::vector<std::string>& command_line) {
  require_given(a.scene, "--scene", "a generator's name or a scene file");
  if (line.has("--final")) require_given(a.final_path, "--final", "the name of a CSV file");
  const Scene drawn = load(a.scene);
  const ReducedScene scene(drawn, Reductions::all_directions());
  std::unique_ptr<CsvFile> csv;
  if (!a.final_path.empty()) {
    csv = std::make_unique<CsvFile>(a.final_path, node_header(drawn.dimension, {}));
  }

  progress().stage("finding the equilibrium");
  const Equilibrium rest = equilibrium_of(scene);
  progress().wipe();
  if (csv) {
    const auto nodes = scene.expand({0, rest.q, Vec::Zero(rest.q.size())});
    for (std::size_t i = 0; i < nodes.size(); ++i) write_node(*csv, i, nodes[i], drawn.dimension);
    nlohmann::json origin = provenance(command_line, drawn);
    origin["outcome"] = name(rest.outcome);
    origin["residual"] = rest.residual;
    origin["smallest_eigenvalue"] = rest.smallest_eigenvalue;
    origin["isolated"] = rest.isolated;
    origin["flat_directions"] = rest.flat_directions;
    origin["iterations"] = rest.iterations;
    csv->commit(origin);
  }
  if (rest.outcome != Equilibrium::Outcome::reached) {
    fmt::print(stderr, "equilibrium: {}\n", rest.message);
    return end_not_reached;
  }
  fmt::print("{}: at rest after {} iterations; largest force {:.2g} N, energy {:.9g} J\n",
             drawn.name, rest.iterations, rest.residual,
             scene.potential({0, rest.q, Vec::Zero(rest.q.size())}));
  fmt::print("smallest eigenvalue of -K: {:.6g} N/m, {}\n", rest.smallest_eigenvalue,
             rest.isolated
                 ? std::string("an isolated minimum")
                 : fmt::format("zero within rounding in {} direction{}: something is "
                               "loose, or too soft to tell, and the minimum is not known "
                               "to be isolated",
                               rest.flat_directions, rest.flat_directions == 1 ? "" : "s"));
  return done;
}

}  // namespace
}  // namespace qddot::equilibrium

int main(int argc, char** argv) {
  using namespace qddot::equilibrium;
  return qddot::kit::enter<Arguments>(
      {.name = "equilibrium",
       .summary =
           "Finds the stable equilibrium that a scene reaches downhill from where it is drawn.",
       .has_threads = true},
      declare, equilibrium, argc, argv);
}
