#pragma once

#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot {

// The mass of each unknown [kg].
template <int D>
Vec masses(const Network& network, const Layout<D>& layout) {
  Vec mass(layout.first(static_cast<int>(layout.nodes())));
  for (int i = 0; i < layout.nodes(); ++i) {
    mass.segment(layout.first(i), layout.count(i)).setConstant(network.node_mass[i]);
  }
  return mass;
}

// M g + load [N]: the constant force on each unknown.
template <int D>
Vec weights(const Network& network, const Layout<D>& layout) {
  Vec weight = masses(network, layout);
  for (int i = 0; i < layout.nodes(); ++i) {
    for (int a = 0; a < layout.count(i); ++a) {
      const int d = layout.axis(i, a);
      weight[layout.first(i) + a] *= network.gravity[d];
      if (network.load.size() > 0) weight[layout.first(i) + a] += network.load[D * i + d];
    }
  }
  return weight;
}

}  // namespace qddot
