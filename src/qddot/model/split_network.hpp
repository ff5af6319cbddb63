#pragma once

#include <vector>

#include "qddot/model/mass_spring.hpp"

namespace qddot {

// The network with only its stiff springs (`stiff`), or with all others: the halves of a Split.
inline Network half_of_split(Network network, bool stiff) {
  const auto is_other = [&](const auto& spring) { return spring.stiff != stiff; };
  std::erase_if(network.links, is_other);
  std::erase_if(network.image_links, is_other);
  std::erase_if(network.anchors, is_other);
  std::erase_if(network.general, is_other);
  if (stiff) {
    network.gravity.setZero();
    network.load.resize(0);
    network.driven_loads.clear();
    network.constant_energy = 0;
  }
  network.rods.clear();
  network.offers_split = false;
  return network;
}

// The nodes that have a spring, ascending.
inline std::vector<int> pulled_nodes(const Network& network) {
  std::vector<char> is_pulled(static_cast<std::size_t>(network.node_mass.size()));
  for (const auto& link : network.links) is_pulled[link.i] = is_pulled[link.j] = 1;
  for (const auto& link : network.image_links) is_pulled[link.i] = is_pulled[link.j] = 1;
  for (const auto& anchor : network.anchors) is_pulled[anchor.i] = 1;
  for (const auto& spring : network.general) {
    is_pulled[spring.i] = 1;
    if (spring.j >= 0) is_pulled[spring.j] = 1;
  }
  std::vector<int> nodes;
  for (int i = 0; i < std::ssize(is_pulled); ++i) {
    if (is_pulled[i]) nodes.push_back(i);
  }
  return nodes;
}

// The network of these nodes alone. All springs of `network` must join them, and it must have no
// loads.
inline Network network_among(const std::vector<int>& nodes, const Network& network) {
  Network core = network;
  core.node_mass = network.node_mass(nodes);
  std::vector<int> place(static_cast<std::size_t>(network.node_mass.size()), -1);
  core.zero_coordinates.clear();
  for (int i = 0; i < std::ssize(nodes); ++i) {
    place[nodes[i]] = i;
    if (!network.zero_coordinates.empty()) {
      core.zero_coordinates.push_back(network.zero_coordinates[nodes[i]]);
    }
  }
  const auto renumber = [&](auto& links) {
    for (auto& link : links) link.i = place[link.i], link.j = place[link.j];
  };
  renumber(core.links);
  renumber(core.image_links);
  for (auto& anchor : core.anchors) anchor.i = place[anchor.i];
  for (auto& spring : core.general) {
    spring.i = place[spring.i];
    if (spring.j >= 0) spring.j = place[spring.j];
  }
  return core;
}

}  // namespace qddot
