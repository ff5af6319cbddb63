// A string of equal masses and springs between two pins, tight and drawn aside at one place, let go
// from rest.
#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

SceneSize size_of_string(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  return {.nodes = count, .springs = count - 1};
}

Scene draw_string(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  const auto springs = static_cast<double>(count - 1);
  const double length = p.at("length"), place = p.at("place"), height = p.at("height");
  Scene scene{.gravity = {0, 0, -p.at("gravity")}, .until = p.at("until")};
  for (std::size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / springs;
    const double aside = part < place ? part / place : (1 - part) / (1 - place);
    scene.nodes.push_back({.position = {length * part, 0, height * length * aside},
                           .mass = p.at("mass") / static_cast<double>(count)});
  }
  scene.nodes.front().pinned = scene.nodes.back().pinned = true;
  const double rest_length = length / springs / (1 + p.at("stretch"));
  for (std::size_t i = 0; i + 1 < count; ++i)
    scene.springs.push_back({{i, i + 1}, {p.at("stiffness"), rest_length}});
  return scene;
}

}  // namespace

Generator plucked_string() {
  return {.name = "plucked_string",
          .summary = "a tight string between two pins, drawn aside and let go",
          .parameters = {{"nodes", 30, 3, 1e6, "how many nodes", true},
                         {"length", 1, least, most, "between the pins in m"},
                         {"mass", 1, least, most, "of all nodes together in kg"},
                         {"stiffness", 1e6, 0, most, "of each spring in N/m"},
                         {"stretch", 0.05, 0, 100, "strain of the straight string"},
                         {"place", 0.25, 0.01, 0.99, "where it is drawn aside, over the length"},
                         {"height", 0.02, -10, 10, "how far, over the length"},
                         {"gravity", 0, -most, most, "g along -z in m/s^2"},
                         {"until", 0.1, least, most, "the end time in s"}},
          .size = size_of_string,
          .draw = draw_string};
}

}  // namespace qddot
