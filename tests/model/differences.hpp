#pragma once

#include <vector>

#include "qddot/model/mass_spring.hpp"

namespace qddot {
inline namespace tests {

// Whether coordinate d of a node does not stay zero.
inline bool is_unknown(const Network& network, int node, int d) {
  return network.zero_coordinates.empty() ||
         !(network.zero_coordinates[static_cast<std::size_t>(node)] >> d & 1);
}

// All coordinates of nodes at unknowns q, and their derivatives by these.
template <class Real>
struct Coordinates {
  using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Dense = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  std::vector<Column> x;
  std::vector<Dense> slope;

  Coordinates(const Network& network, const Vec& q) {
    Index unknown = 0;
    for (int i = 0; i < network.node_mass.size(); ++i) {
      x.push_back(Column::Zero(network.dimension));
      slope.push_back(Dense::Zero(network.dimension, q.size()));
      for (int d = 0; d < network.dimension; ++d) {
        if (!is_unknown(network, i, d)) continue;
        slope[i](d, unknown) = 1;
        x[i][d] = q[unknown++];
      }
    }
  }
};

// Calls use(law, d, g) for every spring, with the difference d of its ends and g = dd/dq.
template <class Real, class Use>
void for_differences(const Network& network, const Vec& q, const Use& use) {
  const Coordinates<Real> at(network, q);
  const auto& [x, slope] = at;
  using Column = typename Coordinates<Real>::Column;
  using Dense = typename Coordinates<Real>::Dense;
  const auto head = [&](const Eigen::Vector3d& v) -> Column {
    return v.head(network.dimension).template cast<Real>();
  };
  for (const auto& [i, j, law, holds, stiff, direction] : network.links)
    use(law, Column(x[j] - x[i]), Dense(slope[j] - slope[i]));
  for (const auto& image : network.image_links) {
    const Dense mirror = head(image.mirror).asDiagonal();
    use(image.law, Column(mirror * x[image.j] - x[image.i]),
        Dense(mirror * slope[image.j] - slope[image.i]));
  }
  for (const auto& anchor : network.anchors)
    use(anchor.law, Column(head(anchor.point) - x[anchor.i]), Dense(-slope[anchor.i]));
}

// K = -sum g' B g over the springs. B(law, l, n): a spring's block at the length l in the direction
// n.
template <class Real, class Block>
typename Coordinates<Real>::Dense sum_of_blocks(const Network& network, const Vec& q,
                                                const Block& block) {
  typename Coordinates<Real>::Dense k = Coordinates<Real>::Dense::Zero(q.size(), q.size());
  for_differences<Real>(network, q, [&](const SpringLaw& law, const auto& d, const auto& g) {
    k -= g.transpose() * block(law, d.norm(), d.normalized()) * g;
  });
  return k;
}

}  // namespace tests
}  // namespace qddot
