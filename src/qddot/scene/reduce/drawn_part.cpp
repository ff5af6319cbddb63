#include "qddot/scene/reduce/drawn_part.hpp"

#include <algorithm>
#include <cmath>

namespace qddot::reduce {
namespace {

// Each coordinate is zero or, if all points are far from zero for the size of the whole, that of
// the first point. Then no two values of a coordinate differ by more than a quarter, so that their
// differences are exact (Sterbenz).
Eigen::Vector3d local_origin(const std::vector<Eigen::Vector3d>& x) {
  constexpr double far = 4;
  Eigen::Vector3d low = x.front(), high = x.front();
  for (const Eigen::Vector3d& point : x) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double size = (high - low).maxCoeff();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (int d = 0; d < 3; ++d) {
    if (std::max(std::abs(low[d]), std::abs(high[d])) > far * size) origin[d] = x.front()[d];
  }
  return origin;
}

}  // namespace

DrawnPart drawn_part(const PartMembers& members, const std::vector<Node>& nodes,
                     const std::vector<Spring>& springs, const Eigen::Vector3d& gravity) {
  DrawnPart drawn{.nodes = members.nodes, .free = members.nodes.size(), .gravity = gravity};
  std::vector<std::size_t> pins;
  for (const std::size_t e : members.springs) {
    for (const std::size_t node : springs[e].nodes) {
      if (nodes[node].pinned) pins.push_back(node);
    }
  }
  std::ranges::sort(pins);
  pins.erase(std::unique(pins.begin(), pins.end()), pins.end());
  drawn.nodes.insert(drawn.nodes.end(), pins.begin(), pins.end());

  for (auto* vectors : {&drawn.x, &drawn.v}) vectors->reserve(drawn.nodes.size());
  double total_mass = 0;
  for (const std::size_t i : drawn.nodes) {
    const Node& node = nodes[i];
    drawn.x.push_back(node.position);
    drawn.v.push_back(node.pinned ? Eigen::Vector3d::Zero() : node.velocity);
    drawn.mass.push_back(node.pinned ? 0 : node.mass);
    drawn.load.push_back(node.acting_load());
    drawn.is_loaded = drawn.is_loaded || !drawn.load.back().isZero(0);
    total_mass += drawn.mass.back();
  }
  if (total_mass == 0) drawn.gravity.setZero();
  drawn.gravity_noise = rounding * drawn.gravity.norm();
  drawn.origin = local_origin(drawn.x);
  for (Eigen::Vector3d& x : drawn.x) x -= drawn.origin;

  // Both runs of the node list are ascending.
  const auto free_end = drawn.nodes.begin() + static_cast<std::ptrdiff_t>(drawn.free);
  const auto number = [&](std::size_t node) {
    const auto found = nodes[node].pinned ? std::lower_bound(free_end, drawn.nodes.end(), node)
                                          : std::lower_bound(drawn.nodes.begin(), free_end, node);
    return static_cast<std::size_t>(found - drawn.nodes.begin());
  };
  drawn.springs.reserve(members.springs.size());
  for (const std::size_t e : members.springs) {
    const auto [a, b] = springs[e].nodes;
    drawn.springs.push_back(
        {{number(a), number(b)}, springs[e].law, springs[e].holds, springs[e].stiff});
  }
  return drawn;
}

double largest_coordinate(const std::vector<Eigen::Vector3d>& vectors) {
  double largest = 0;
  for (const Eigen::Vector3d& x : vectors) {
    largest = std::max(largest, x.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

}  // namespace qddot::reduce
