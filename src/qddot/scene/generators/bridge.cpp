// A truss bridge between two banks that a truck in its middle breaks: two chords of equal panels
// with posts and crossed diagonals, in the plane of x and y. Each member breaks at one strain.
#include <cmath>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

SceneSize size_of_bridge(const GeneratorValues& p) {
  const auto panels = static_cast<std::size_t>(p.at("panels"));
  return {.nodes = 2 * (panels + 1), .springs = 5 * panels + 1};
}

Scene draw_bridge(const GeneratorValues& p) {
  const auto panels = static_cast<std::size_t>(p.at("panels"));
  const double panel = p.at("length") / static_cast<double>(panels), height = p.at("height");
  Scene scene{.dimension = 2, .gravity = {0, -p.at("gravity"), 0}, .until = p.at("until")};
  const SceneSize size = size_of_bridge(p);
  // Node 2 i is on the roadway, node 2 i + 1 above it.
  for (std::size_t i = 0; i <= panels; ++i) {
    for (const double y : {0.0, height}) {
      scene.nodes.push_back({.position = {panel * static_cast<double>(i), y, 0},
                             .mass = p.at("mass") / static_cast<double>(size.nodes),
                             .pinned = y == 0 && (i == 0 || i == panels)});
    }
  }
  scene.nodes[2 * (panels / 2)].mass += p.at("truck");
  const auto join = [&](std::size_t a, std::size_t b) {
    const double length = (scene.nodes[b].position - scene.nodes[a].position).norm();
    scene.springs.push_back({{a, b},
                             {.stiffness = p.at("modulus") / length,
                              .rest_length = length,
                              .breaks_at = p.at("breaks_at")}});
  };
  join(0, 1);
  for (std::size_t i = 0; i < panels; ++i) {
    const std::size_t low = 2 * i, high = low + 1;
    join(low, low + 2);
    join(high, high + 2);
    join(low, high + 2);
    join(high, low + 2);
    join(low + 2, high + 2);
  }
  return scene;
}

}  // namespace

Generator bridge() {
  return {.name = "bridge",
          .summary = "a truss bridge that a truck in its middle breaks",
          .parameters = {{"panels", 8, 2, 1e5, "how many panels", true},
                         {"length", 8, least, most, "between the banks in m"},
                         {"height", 1, least, most, "of a panel in m"},
                         {"mass", 100, least, most, "of all nodes together in kg"},
                         {"modulus", 1e6, least, most, "k times length of each member in N"},
                         {"truck", 1500, 0, most, "on the node in the middle in kg"},
                         {"breaks_at", 0.02, least, most, "the strain at which members break"},
                         {"gravity", 9.81, -most, most, "g along -y in m/s^2"},
                         {"until", 1, least, most, "the end time in s"}},
          .size = size_of_bridge,
          .draw = draw_bridge};
}

}  // namespace qddot
