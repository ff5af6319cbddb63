#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "qddot/model/mass_spring.hpp"

namespace qddot {

// Moves links and anchors that are not plain to Network::general, numbered after those that are
// there.
inline void set_apart_general(Network& network) {
  int next = 0;
  for (const auto& spring : network.general) next = std::max(next, spring.number + 1);
  const auto is_general = [](const auto& spring) { return spring.law.is_general(); };
  if (std::ranges::any_of(network.image_links, is_general))
    throw std::invalid_argument("a spring to a mirror image neither breaks nor goes slack");
  for (const auto& link : network.links) {
    if (!is_general(link)) continue;
    network.general.push_back({.i = link.i,
                               .j = link.j,
                               .point = Eigen::Vector3d::Zero(),
                               .law = link.law,
                               .stiff = link.stiff,
                               .number = next++});
  }
  for (const auto& anchor : network.anchors) {
    if (!is_general(anchor)) continue;
    network.general.push_back({.i = anchor.i,
                               .j = -1,
                               .point = anchor.point,
                               .law = anchor.law,
                               .stiff = anchor.stiff,
                               .curve = anchor.curve,
                               .number = next++});
  }
  std::erase_if(network.links, is_general);
  std::erase_if(network.anchors, is_general);
}

}  // namespace qddot
