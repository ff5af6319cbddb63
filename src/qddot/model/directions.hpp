#pragma once

#include <stdexcept>
#include <vector>

#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot {

// The directions of all springs of a network, 0 for a spring without one; empty if none has one.
// First come links, image links and anchors whose nodes have only unknown coordinates, then the
// others likewise. Throws std::invalid_argument if directions are not allowed (see Network).
template <int D>
std::vector<signed char> directions(const Network& network, const Layout<D>& layout) {
  std::vector<signed char> inner_links, inner_anchors, edge_links, edge_anchors;
  bool any = false, all = true;
  const auto take = [&](const auto& spring, std::vector<signed char>& list) {
    list.push_back(static_cast<signed char>(spring.direction));
    any = any || spring.direction != 0;
    all = all && (spring.direction != 0 || spring.law.is_linear());
    if (spring.direction != 0 && (D > 1 || spring.law.quartic > 0)) {
      throw std::invalid_argument("only a spring without quartic term on a line has a direction");
    }
  };
  const auto take_link = [&](const auto& link) {
    take(link, layout.is_full(link.i) && layout.is_full(link.j) ? inner_links : edge_links);
  };
  for (const auto& link : network.links) take_link(link);
  for (const auto& link : network.image_links) take_link(link);
  for (const auto& anchor : network.anchors) {
    take(anchor, layout.is_full(anchor.i) ? inner_anchors : edge_anchors);
  }
  all = all && network.general.empty();
  if (!any) return {};
  if (!all) throw std::invalid_argument("some springs have a direction and others do not");
  for (const auto* more : {&inner_anchors, &edge_links, &edge_anchors}) {
    inner_links.insert(inner_links.end(), more->begin(), more->end());
  }
  return inner_links;
}

}  // namespace qddot
