#include "qddot/scene/mesh/lumped_mass.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "qddot/scene/mesh/mesh_elements.hpp"

namespace qddot::mesh {
namespace {

using Eigen::Vector3d;
using Points = std::span<const Vector3d>;

// Half the sum of x_k x x_k+1 around the polygon.
double polygon_area(Points corners) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k)
    sum += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
  return 0.5 * sum.norm();
}

// Six times the volume between the origin and a side of three or four corners. That to a bilinear
// side is the mean of those to both pairs of triangles that its diagonals make.
double six_volumes(Points side) {
  const auto six = [&](std::size_t a, std::size_t b, std::size_t c) {
    return side[a].dot(side[b].cross(side[c]));
  };
  if (side.size() == 3) return six(0, 1, 2);
  return 0.5 * (six(0, 1, 2) + six(0, 2, 3) + six(0, 1, 3) + six(1, 2, 3));
}

// By the theorem of Gauss.
double solid_volume(Points corners) {
  const Element& element = *std::ranges::find_if(elements, [&](const Element& one) {
    return one.dimension == 3 && one.corners == corners.size();
  });
  double sum = 0;
  std::vector<Vector3d> side;
  for (const char place : element.sides) {
    if (place != ' ') {
      side.push_back(corners[std::size_t(place - '0')] - corners[0]);
      continue;
    }
    sum += six_volumes(side);
    side.clear();
  }
  return std::abs(sum + six_volumes(side)) / 6;
}

}  // namespace

double element_size(int dimension, Points corners) {
  if (dimension == 1) return (corners[1] - corners[0]).norm();
  return dimension == 2 ? polygon_area(corners) : solid_volume(corners);
}

std::vector<double> lumped_masses(const Mesh& mesh, double density) {
  const int highest = mesh.cells.highest_dimension();
  // Each element of that dimension by its corners in order, to find those that are listed twice.
  std::vector<std::pair<std::vector<std::size_t>, std::size_t>> order;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    if (mesh.cells.dimension(e) != highest) continue;
    const auto corners = mesh.cells.corners(e);
    order.emplace_back(std::vector(corners.begin(), corners.end()), e);
    std::ranges::sort(order.back().first);
  }
  std::ranges::sort(order);
  std::vector<double> masses(mesh.vertices.size(), 0);
  std::vector<Vector3d> places;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && order[k].first == order[k - 1].first) continue;
    const auto corners = mesh.cells.corners(order[k].second);
    places.clear();
    for (const std::size_t corner : corners) places.push_back(mesh.vertices[corner]);
    const double share =
        density * element_size(highest, places) / static_cast<double>(corners.size());
    for (const std::size_t corner : corners) masses[corner] += share;
  }
  return masses;
}

}  // namespace qddot::mesh
