#pragma once

#include <stdexcept>
#include <vector>

#include "src/model/layout.hpp"
#include "src/model/mass_spring.hpp"

namespace qddot {

// The offsets [m] of all springs of a network: of links, image links and anchors at nodes all of
// whose coordinates are unknowns, then of the others likewise. Empty where none has any; throws
// std::invalid_argument on one that may not have it (see Network).
template <int D>
std::vector<double> offsets(const Network& network, const Layout<D>& layout) {
  std::vector<double> inner_links, inner_anchors, edge_links, edge_anchors;
  bool any = false;
  const auto take = [&](const auto& spring, std::vector<double>& all) {
    all.push_back(spring.offset);
    if (spring.offset == 0) return;
    any = true;
    if (D > 1 || !spring.law.is_linear()) {
      throw std::invalid_argument("only a spring of rest length zero on a line has an offset");
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
  if (!any) return {};
  for (const auto* more : {&inner_anchors, &edge_links, &edge_anchors}) {
    inner_links.insert(inner_links.end(), more->begin(), more->end());
  }
  return inner_links;
}

// Adds the constant part of the force k (d - r) of all springs with an offset r to `force`.
inline void add_pulls(const Network& network, const Layout<1>& layout, Vec& force) {
  using Pull = Layout<1>::Point;
  const auto pull = [](const auto& spring) { return spring.law.stiffness * spring.offset; };
  for (const auto& link : network.links) {
    layout.add(Pull(-pull(link)), link.i, force);
    layout.add(Pull(pull(link)), link.j, force);
  }
  for (const auto& link : network.image_links) {
    layout.add(Pull(-pull(link)), link.i, force);
    layout.add(Pull(link.mirror[0] * pull(link)), link.j, force);
  }
  for (const auto& anchor : network.anchors) layout.add(Pull(-pull(anchor)), anchor.i, force);
}

}  // namespace qddot
