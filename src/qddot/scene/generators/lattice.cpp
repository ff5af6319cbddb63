// A cantilever: a block of nodes on a cubic grid, one face pinned, under gravity. Each node is
// joined to its 26 neighbours, along edges, face diagonals and space diagonals.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

// One of each opposite pair of the 26 directions to a neighbour.
constexpr std::array<std::array<int, 3>, 13> directions = {{{1, 0, 0},
                                                            {0, 1, 0},
                                                            {0, 0, 1},
                                                            {1, 1, 0},
                                                            {1, -1, 0},
                                                            {1, 0, 1},
                                                            {1, 0, -1},
                                                            {0, 1, 1},
                                                            {0, 1, -1},
                                                            {1, 1, 1},
                                                            {1, 1, -1},
                                                            {1, -1, 1},
                                                            {1, -1, -1}}};

SceneSize size_of_lattice(const GeneratorValues& p) {
  // The number of pairs of nodes along an axis that are 0 or 1 apart.
  const auto pairs = [&](const char* nodes, int apart) {
    return static_cast<std::size_t>(p.at(nodes)) - static_cast<std::size_t>(std::abs(apart));
  };
  SceneSize size{.nodes = pairs("nodes_x", 0) * pairs("nodes_y", 0) * pairs("nodes_z", 0)};
  for (const auto& [dx, dy, dz] : directions)
    size.springs += pairs("nodes_x", dx) * pairs("nodes_y", dy) * pairs("nodes_z", dz);
  return size;
}

}  // namespace

Generator lattice() {
  return {.name = "lattice",
          .summary = "a cantilever block of masses and springs, one face pinned",
          .parameters = {{"nodes_x", 24, 1, 4000, "nodes along the beam", true},
                         {"nodes_y", 8, 1, 4000, "nodes across", true},
                         {"nodes_z", 8, 1, 4000, "nodes in height", true},
                         {"length", 1, least, most, "the beam's length in m"},
                         {"mass", 1, least, most, "of all nodes together in kg"},
                         {"stiffness", 5e4, 0, most, "of each spring in N/m"},
                         {"gravity", 9.81, -most, most, "g along -z in m/s^2"},
                         {"until", 0.2, least, most, "the end time in s"}},
          .size = size_of_lattice,
          .draw = [](const GeneratorValues& p) {
            const int nx = static_cast<int>(p.at("nodes_x")),
                      ny = static_cast<int>(p.at("nodes_y")),
                      nz = static_cast<int>(p.at("nodes_z"));
            const double spacing = p.at("length") / std::max(1, nx - 1);
            const double count = static_cast<double>(nx) * ny * nz;
            const auto index = [&](int x, int y, int z) {
              return (static_cast<std::size_t>(x) * ny + y) * nz + z;
            };
            Scene scene{.gravity = {0, 0, -p.at("gravity")}, .until = p.at("until")};
            const SceneSize size = size_of_lattice(p);
            scene.nodes.reserve(size.nodes);
            scene.springs.reserve(size.springs);
            for (int x = 0; x < nx; ++x) {
              for (int y = 0; y < ny; ++y) {
                for (int z = 0; z < nz; ++z) {
                  scene.nodes.push_back({.position = spacing * Eigen::Vector3d(x, y, z),
                                         .mass = p.at("mass") / count,
                                         .pinned = x == 0});
                  for (const auto& [dx, dy, dz] : directions) {
                    const int x2 = x - dx, y2 = y - dy, z2 = z - dz;
                    if (x2 < 0 || y2 < 0 || y2 >= ny || z2 < 0 || z2 >= nz) continue;
                    const double rest = spacing * Eigen::Vector3d(dx, dy, dz).norm();
                    scene.springs.push_back(
                        {{index(x2, y2, z2), index(x, y, z)}, {p.at("stiffness"), rest}});
                  }
                }
              }
            }
            return scene;
          }};
}

}  // namespace qddot
