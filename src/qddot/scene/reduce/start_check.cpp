#include "qddot/scene/reduce/start_check.hpp"

#include <fmt/format.h>

#include "qddot/scene/reduce/as_drawn.hpp"
#include "qddot/scene/reduce/words.hpp"

namespace qddot::reduce {
namespace {

std::string energy_instead_of(double reduced, double drawn) {
  return fmt::format("the energy at the start would be {:.10g} J instead of {:.10g}", reduced,
                     drawn);
}

}  // namespace

void require_drawn_start(const Model& model, const Pieces& pieces, const Scene& scene) {
  std::vector<int> places(pieces.nodes.size(), 0);
  for (const Part& part : pieces.parts) {
    for (const std::size_t node : part.nodes()) ++places[node];
  }
  for (const Flying& flying : pieces.flying) ++places[flying.node];
  for (const Series& series : pieces.series) {
    for (const auto& joint : series.joints) ++places[joint.node];
  }
  const State& start = model.initial();
  const std::vector<Node> nodes = model.expand(start);
  std::vector<Eigen::Vector3d> x, v;
  std::vector<double> mass;
  std::vector<Eigen::Vector3d> load;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (places[i] != (nodes[i].pinned ? 0 : 1)) {
      throw defect(fmt::format("node {} has {} places", i, places[i]));
    }
    x.push_back(nodes[i].position);
    v.push_back(nodes[i].velocity);
    mass.push_back(nodes[i].pinned ? 0 : nodes[i].mass);
    load.push_back(nodes[i].acting_load());
  }
  const Tolerances tolerances = tolerances_of(x, v);
  const BoundedEnergy t = kinetic_of(v, mass, tolerances);
  const BoundedEnergy p = potential_of(scene.springs, x, mass, scene.gravity, load, tolerances);
  if (differs(t, model.kinetic(start)))
    throw defect(energy_instead_of(model.kinetic(start), t.value));
  if (differs(p, model.potential(start)))
    throw defect(energy_instead_of(model.potential(start), p.value));
}

}  // namespace qddot::reduce
