// A hanging chain: equal masses on equal springs along x, let go from the horizontal at rest
// lengths, one or both ends pinned.
#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

SceneSize size_of_chain(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  return {.nodes = count, .springs = count - 1};
}

}  // namespace

Generator chain() {
  return {.name = "chain",
          .summary = "a row of masses on springs, let go from the horizontal",
          .parameters = {{"nodes", 100, 2, 1e7, "how many nodes", true},
                         {"length", 1, least, most, "the length in m"},
                         {"mass", 1, least, most, "of all nodes together in kg"},
                         {"stiffness", 1e6, 0, most, "of each spring in N/m"},
                         {"pinned_ends", 1, 0, 2, "how many ends are pinned", true},
                         {"gravity", 9.81, -most, most, "g along -z in m/s^2"},
                         {"until", 0.1, least, most, "the end time in s"}},
          .size = size_of_chain,
          .draw = [](const GeneratorValues& p) {
            const auto count = static_cast<std::size_t>(p.at("nodes"));
            const double rest_length = p.at("length") / static_cast<double>(count - 1);
            Scene scene{.gravity = {0, 0, -p.at("gravity")}, .until = p.at("until")};
            for (std::size_t i = 0; i < count; ++i) {
              scene.nodes.push_back({.position = {rest_length * static_cast<double>(i), 0, 0},
                                     .mass = p.at("mass") / static_cast<double>(count)});
            }
            scene.nodes.front().pinned = p.at("pinned_ends") >= 1;
            scene.nodes.back().pinned = p.at("pinned_ends") >= 2;
            for (std::size_t i = 0; i + 1 < count; ++i) {
              scene.springs.push_back({{i, i + 1}, {p.at("stiffness"), rest_length}});
            }
            return scene;
          }};
}

}  // namespace qddot
