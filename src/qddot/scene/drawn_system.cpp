#include "qddot/scene/drawn_system.hpp"

#include <algorithm>
#include <iterator>

#include "qddot/model/constrained_system.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot {

std::unique_ptr<System> drawn_system(const Scene& scene) {
  Network network{.dimension = scene.dimension, .gravity = scene.gravity};
  network.node_mass = Vec::Zero(std::ssize(scene.nodes));
  std::vector<bool> is_held;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (!node.pinned) network.node_mass[static_cast<Index>(i)] = node.mass;
    std::fill_n(std::back_inserter(is_held), scene.dimension, node.pinned);
  }
  for (const Spring& spring : scene.springs) {
    network.links.push_back({static_cast<int>(spring.nodes[0]), static_cast<int>(spring.nodes[1]),
                             spring.law, spring.holds});
  }
  return std::make_unique<ConstrainedSystem>(make_mass_spring(network), std::move(is_held));
}

}  // namespace qddot
