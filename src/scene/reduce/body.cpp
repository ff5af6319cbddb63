#include "qddot/scene/reduce/body.hpp"

#include <algorithm>
#include <cmath>

namespace qddot::reduce {
namespace {

// Coordinate by coordinate zero, or that of the first point where all are far from zero for the
// size of the whole. There no two of a coordinate differ by more than a quarter, so that their
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

Body make_body(const Component& component, const std::vector<Node>& nodes,
               const std::vector<Spring>& springs, const Eigen::Vector3d& gravity) {
  Body body{.nodes = component.nodes, .free = component.nodes.size(), .gravity = gravity};
  std::vector<std::size_t> pins;
  for (const std::size_t e : component.springs) {
    for (const std::size_t node : springs[e].nodes) {
      if (nodes[node].pinned) pins.push_back(node);
    }
  }
  std::ranges::sort(pins);
  pins.erase(std::unique(pins.begin(), pins.end()), pins.end());
  body.nodes.insert(body.nodes.end(), pins.begin(), pins.end());

  for (auto* vectors : {&body.x, &body.v}) vectors->reserve(body.nodes.size());
  double total_mass = 0;
  for (const std::size_t i : body.nodes) {
    const Node& node = nodes[i];
    body.x.push_back(node.position);
    body.v.push_back(node.pinned ? Eigen::Vector3d::Zero() : node.velocity);
    body.mass.push_back(node.pinned ? 0 : node.mass);
    total_mass += body.mass.back();
  }
  if (total_mass == 0) body.gravity.setZero();
  body.origin = local_origin(body.x);
  for (Eigen::Vector3d& x : body.x) x -= body.origin;

  // Both runs of the node list are ascending.
  const auto free_end = body.nodes.begin() + static_cast<std::ptrdiff_t>(body.free);
  const auto number = [&](std::size_t node) {
    const auto found = nodes[node].pinned ? std::lower_bound(free_end, body.nodes.end(), node)
                                          : std::lower_bound(body.nodes.begin(), free_end, node);
    return static_cast<std::size_t>(found - body.nodes.begin());
  };
  body.springs.reserve(component.springs.size());
  for (const std::size_t e : component.springs) {
    const auto [a, b] = springs[e].nodes;
    body.springs.push_back(
        {{number(a), number(b)}, springs[e].law, springs[e].holds, springs[e].stiff});
  }
  return body;
}

double largest_coordinate(const std::vector<Eigen::Vector3d>& vectors) {
  double largest = 0;
  for (const Eigen::Vector3d& x : vectors) {
    largest = std::max(largest, x.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

}  // namespace qddot::reduce
