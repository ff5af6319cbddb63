// A square net of cables, drawn flat and slack between four pinned corners. It falls, and its
// cables go taut and slack by turns.
#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

SceneSize size_of_net(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  return {.nodes = count * count, .springs = 2 * count * (count - 1)};
}

Scene draw_net(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  const double spacing = p.at("size") / static_cast<double>(count - 1);
  const SpringLaw cable{.stiffness = p.at("stiffness"),
                        .rest_length = spacing * (1 + p.at("slack")),
                        .pulls_only = true};
  Scene scene{.gravity = {0, 0, -p.at("gravity")}, .until = p.at("until")};
  const auto is_end = [&](std::size_t i) { return i == 0 || i == count - 1; };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      scene.nodes.push_back(
          {.position = {spacing * static_cast<double>(i), spacing * static_cast<double>(j), 0},
           .mass = p.at("mass") / static_cast<double>(count * count),
           .pinned = is_end(i) && is_end(j)});
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t node = i * count + j;
      if (j + 1 < count) scene.springs.push_back({{node, node + 1}, cable});
      if (i + 1 < count) scene.springs.push_back({{node, node + count}, cable});
    }
  }
  return scene;
}

}  // namespace

Generator cable_net() {
  return {.name = "cable_net",
          .summary = "a net of cables, slack at first, that falls between four pins",
          .parameters = {{"nodes", 8, 2, 3000, "how many nodes along a side", true},
                         {"size", 1, least, most, "of a side as drawn in m"},
                         {"slack", 0.05, 0, 100, "of the cables as drawn, over their length"},
                         {"mass", 1, least, most, "of all nodes together in kg"},
                         {"stiffness", 2000, 0, most, "of each cable in N/m"},
                         {"gravity", 9.81, -most, most, "g along -z in m/s^2"},
                         {"until", 0.3, least, most, "the end time in s"}},
          .size = size_of_net,
          .draw = draw_net};
}

}  // namespace qddot
