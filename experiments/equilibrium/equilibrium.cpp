// The static shape of a scene: a stable minimum of its potential energy, downhill from the drawn
// positions.
//
//   equilibrium --scene cloth --final rest.csv
#include <optional>

#include <fmt/format.h>

#include "experiments/kit/node_table.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "qddot/measure/motion/momenta.hpp"
#include "qddot/scene/settle.hpp"

namespace {

// Whether the minimum is an isolated one; if not, why.
std::string isolation_in_words(const qddot::Equilibrium& rest, const qddot::Scene& scene) {
  if (rest.isolated) return "an isolated minimum";
  // Each conserved momentum belongs to a motion of the whole that changes no spring.
  const qddot::Momenta momenta(scene);
  const auto of_the_whole =
      momenta.linear(scene.nodes, 0).size() + momenta.angular(scene.nodes).size();
  const std::string flat = fmt::format("zero within rounding in {} direction{}",
                                       rest.flat_directions, rest.flat_directions == 1 ? "" : "s");
  if (rest.flat_directions <= of_the_whole) {
    return flat + ", in which the scene moves and turns as a whole: pins leave it free to";
  }
  return flat +
         (of_the_whole > 0 ? fmt::format(", {} of them motions of the whole", of_the_whole) : "") +
         ": something is loose, or too soft to tell, and the minimum is not known to be isolated";
}

}  // namespace

int main(int argc, char** argv) {
  using namespace qddot;
  Program p("equilibrium",
            "Finds the stable equilibrium that a scene reaches downhill from where it is drawn.",
            {has_threads});
  auto scene = p.drawn_scene();
  auto path = p.word("--final",
                     "CSV of all nodes at rest (or, with status 3, where the search ended), with "
                     "velocities of zero: node,x,y,z,vx,vy,vz")
                  .check([](const std::string& given, const std::string& name) {
                    require_given(given, name, "the name of a CSV file");
                  });
  return p.run(argc, argv, [&]() -> int {
    const Scene drawn = load(scene);
    const ReducedScene reduced(drawn, Reductions::all_directions());
    std::optional<CsvFile> csv;
    if (path.is_given()) csv.emplace(*path, node_header(drawn.dimension, {}));

    progress().stage("finding the equilibrium");
    const Equilibrium rest = equilibrium_of(reduced);
    progress().wipe();
    if (csv) {
      const auto nodes = reduced.expand({0, rest.q, Vec::Zero(rest.q.size())});
      write_nodes(*csv, nodes, drawn.dimension);
      nlohmann::json origin = provenance(p.command_line(), drawn);
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
               reduced.potential({0, rest.q, Vec::Zero(rest.q.size())}));
    fmt::print("smallest eigenvalue of -K: {:.6g} N/m, {}\n", rest.smallest_eigenvalue,
               isolation_in_words(rest, drawn));
    return done;
  });
}
