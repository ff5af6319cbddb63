// The static shape of a scene: a stable minimum of its potential energy, downhill from the drawn
// positions.
//
//   equilibrium --scene cloth --final rest.csv
//   equilibrium --scene lattice --out results/lattice
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/kit/node_table.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "qddot/measure/motion/momenta.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot {
namespace {

std::vector<std::string> shape_header(int dimension) {
  std::vector<std::string> header = {"node"};
  for (const char* kind : {"", "d"}) {
    for (int d = 0; d < dimension; ++d) header.push_back(fmt::format("{}{}", kind, "xyz"[d]));
  }
  return header;
}

// Writes a row for each node: index, position as drawn [m], displacement from there to rest [m].
void write_shape(CsvFile& csv, const Scene& drawn, const std::vector<Node>& rest) {
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Eigen::Vector3d& from = drawn.nodes[i].position;
    const Eigen::Vector3d moved = rest[i].position - from;
    csv.field(i);
    for (int d = 0; d < drawn.dimension; ++d) csv.field(from[d]);
    for (int d = 0; d < drawn.dimension; ++d) csv.field(moved[d]);
    csv.end_row();
  }
}

// Whether the minimum is an isolated one; if not, why.
std::string isolation_in_words(const Equilibrium& rest, const Scene& scene) {
  if (rest.isolated) return "an isolated minimum";
  // Each conserved momentum belongs to a motion of the whole that changes no spring.
  const Momenta momenta(scene);
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
}  // namespace qddot

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
  auto out = p.word("--out",
                    "the folder for shape.csv (the nodes as drawn, and how far each lies from "
                    "there at rest) and springs.csv")
                 .check([](const std::string& folder, const std::string& name) {
                   require_given(folder, name, "the folder for the results");
                 });
  return p.run(argc, argv, [&]() -> int {
    const Scene drawn = load(scene);
    require_no_rods(drawn, scene->name, "places of rest are looked for without constraints");
    const Model model(drawn, Reductions::all_directions());
    std::optional<CsvFile> csv;
    if (path.is_given()) csv.emplace(*path, node_header(drawn.dimension, {}));
    std::optional<CsvFile> shape, springs;
    if (out.is_given()) {
      require_folder(out);
      shape.emplace(*out + "/shape.csv", shape_header(drawn.dimension));
      springs.emplace(*out + "/springs.csv", std::vector<std::string>{"i", "j"});
    }

    progress().stage("finding the equilibrium");
    const Equilibrium rest = equilibrium_of(model);
    progress().wipe();
    const auto nodes = model.expand({0, rest.q, Vec::Zero(rest.q.size())});
    nlohmann::json origin = provenance(p.command_line(), drawn);
    origin["outcome"] = name(rest.outcome);
    origin["residual"] = rest.residual;
    origin["smallest_eigenvalue"] = rest.smallest_eigenvalue;
    origin["isolated"] = rest.isolated;
    origin["flat_directions"] = rest.flat_directions;
    origin["iterations"] = rest.iterations;
    if (csv) {
      write_nodes(*csv, nodes, drawn.dimension);
      csv->commit(origin);
    }
    if (shape) {
      origin["gravity"] = drawn.gravity;
      write_shape(*shape, drawn, nodes);
      for (const Spring& spring : drawn.springs) springs->row(spring.nodes[0], spring.nodes[1]);
      shape->commit(origin);
      springs->commit(origin);
    }
    if (rest.outcome != Equilibrium::Outcome::reached) {
      fmt::print(stderr, "equilibrium: {}\n", rest.message);
      return end_not_reached;
    }
    fmt::print("{}: at rest after {} iterations; largest force {:.2g} N, energy {:.9g} J\n",
               drawn.name, rest.iterations, rest.residual,
               model.potential({0, rest.q, Vec::Zero(rest.q.size())}));
    fmt::print("smallest eigenvalue of -K: {:.6g} N/m, {}\n", rest.smallest_eigenvalue,
               isolation_in_words(rest, drawn));
    return done;
  });
}
