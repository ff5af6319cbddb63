#include "qddot/scene/mesh/weld.hpp"

#include <algorithm>
#include <numeric>

#include <boost/pending/disjoint_sets.hpp>

namespace qddot::mesh {

std::vector<std::size_t> welded(const std::vector<Eigen::Vector3d>& vertices, double distance) {
  // Vertices that are near each other are near each other along any direction. Few others share a
  // place along this one, which no grid is aligned with.
  const Eigen::Vector3d along = Eigen::Vector3d(0.3711, 0.5213, 0.7684).normalized();
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < vertices.size(); ++i) order.emplace_back(along.dot(vertices[i]), i);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> rank(vertices.size()), parent(vertices.size());
  boost::disjoint_sets sets(rank.data(), parent.data());
  for (std::size_t i = 0; i < vertices.size(); ++i) sets.make_set(i);
  for (std::size_t k = 0, first = 0; k < order.size(); ++k) {
    const auto& [place, i] = order[k];
    // Places round.
    const double reach = distance + 4 * 0x1p-52 * vertices[i].norm();
    while (order[first].first < place - reach) ++first;
    for (std::size_t other = first; other < k; ++other) {
      const std::size_t j = order[other].second;
      if ((vertices[i] - vertices[j]).norm() <= distance) sets.union_set(i, j);
    }
  }
  std::vector<std::size_t> least(vertices.size()), to(vertices.size());
  std::iota(least.begin(), least.end(), 0);
  for (std::size_t i = 0; i < to.size(); ++i) {
    std::size_t& own = least[sets.find_set(i)];
    own = std::min(own, i);
  }
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = least[sets.find_set(i)];
  return to;
}

void weld(const std::vector<std::size_t>& to, Mesh& mesh) {
  std::vector<std::size_t> number(to.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i] == i) mesh.vertices[kept] = mesh.vertices[i], number[i] = kept++;
  }
  mesh.vertices.resize(kept);
  const auto move = [&](auto& all) {
    for (auto& corners : all) {
      for (std::size_t& corner : corners) corner = number[to[corner]];
    }
  };
  move(mesh.edges);
  move(mesh.triangles);
  move(mesh.tetrahedra);
  move(mesh.faces);
  for (std::size_t& corner : mesh.cells.all_corners()) corner = number[to[corner]];
  for (Group& group : mesh.groups) {
    for (std::size_t& vertex : group.vertices) vertex = number[to[vertex]];
  }
}

}  // namespace qddot::mesh
