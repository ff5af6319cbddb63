#include "qddot/scene/reduce/start_check.hpp"

#include <algorithm>

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
  double farthest = 0, fastest = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (places[i] != (nodes[i].pinned ? 0 : 1)) {
      throw defect(fmt::format("node {} has {} places", i, places[i]));
    }
    farthest = std::max(farthest, nodes[i].position.lpNorm<Eigen::Infinity>());
    fastest = std::max(fastest, nodes[i].velocity.lpNorm<Eigen::Infinity>());
  }
  const Tolerances tolerances = tolerances_of(farthest, fastest);
  DrawnKinetic kinetic(tolerances);
  DrawnPotential potential(scene.gravity, tolerances, farthest);
  for (const Spring& spring : scene.springs) {
    potential.add(spring.law,
                  (nodes[spring.nodes[1]].position - nodes[spring.nodes[0]].position).norm());
  }
  for (const Node& node : nodes) {
    const double mass = node.pinned ? 0 : node.mass;
    kinetic.add(mass, node.velocity);
    potential.add(mass, node.position, node.acting_load());
  }
  const BoundedEnergy t = kinetic.sum(), p = potential.sum();
  if (differs(t, model.kinetic(start)))
    throw defect(energy_instead_of(model.kinetic(start), t.value));
  if (differs(p, model.potential(start)))
    throw defect(energy_instead_of(model.potential(start), p.value));
}

}  // namespace qddot::reduce
