#include "qddot/measure/motion/rest.hpp"

#include <algorithm>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

void reach_to_pins(Scales& scales, const Scene& drawn) {
  const std::vector<Node>& nodes = drawn.nodes;
  std::vector<double> reach(nodes.size(), 0);
  for (const Spring& spring : drawn.springs) {
    const auto [i, j] = spring.nodes;
    if (nodes[j].pinned) reach[i] = std::max(reach[i], nodes[j].position.lpNorm<Eigen::Infinity>());
    if (nodes[i].pinned) reach[j] = std::max(reach[j], nodes[i].position.lpNorm<Eigen::Infinity>());
  }
  for (PartScale& part : scales.parts) {
    for (const std::size_t i : part.nodes) part.extent = std::max(part.extent, reach[i]);
  }
}

bool take_extents_at_rest(Scales& scales, double roundings) {
  const bool rests = std::ranges::all_of(scales.parts, [&](const PartScale& part) {
    return part.displacement <= roundings * machine_epsilon * part.extent;
  });
  for (PartScale& part : scales.parts) {
    if (!rests) break;
    part.displacement = part.extent;
    scales.displacement = std::max(scales.displacement, part.extent);
  }
  return rests;
}

}  // namespace qddot::inline measure
