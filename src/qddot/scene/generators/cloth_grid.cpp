#include "qddot/scene/generators/cloth_grid.hpp"

#include "qddot/scene/generators/ranges.hpp"

namespace qddot {

std::vector<GeneratorParameter> cloth_parameters() {
  return {{"nodes", 30, 2, 4000, "how many nodes along a side", true},
          {"side", 1, least, most, "the side in m"},
          {"mass", 0.5, least, most, "of the whole cloth in kg"},
          {"structural_stiffness", 1000, 0, most, "between neighbours in N/m"},
          {"shear_stiffness", 500, 0, most, "across the cells' diagonals in N/m"},
          {"bending_stiffness", 100, 0, most, "between second neighbours in N/m"},
          {"gravity", 9.81, -most, most, "g along -z in m/s^2"},
          {"until", 0.1, least, most, "the end time in s"}};
}

SceneSize cloth_size(const GeneratorValues& p) {
  const auto n = static_cast<std::size_t>(p.at("nodes"));
  const std::size_t structural = 2 * n * (n - 1), shear = 2 * (n - 1) * (n - 1);
  const std::size_t bending = 2 * n * (n - 2);
  return {.nodes = n * n, .springs = structural + shear + bending};
}

Scene draw_cloth(const GeneratorValues& p) {
  const int count = static_cast<int>(p.at("nodes"));
  const double spacing = p.at("side") / (count - 1);
  Scene scene{.gravity = {0, 0, -p.at("gravity")}, .until = p.at("until")};
  const SceneSize size = cloth_size(p);
  scene.nodes.reserve(size.nodes);
  scene.springs.reserve(size.springs);
  const double mass = p.at("mass") / (count * count);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      scene.nodes.push_back({.position = {spacing * i, spacing * j, 0},
                             .mass = mass,
                             .pinned = j == 0 && (i == 0 || i == count - 1)});
    }
  }
  const auto node = [&](int i, int j) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(count) +
           static_cast<std::size_t>(j);
  };
  const auto join = [&](int i, int j, int i2, int j2, double stiffness) {
    if (i2 >= count || j2 >= count || j2 < 0) return;
    const std::size_t a = node(i, j), b = node(i2, j2);
    const double rest = (scene.nodes[b].position - scene.nodes[a].position).norm();
    scene.springs.push_back({{a, b}, {stiffness, rest}});
  };
  const double structural = p.at("structural_stiffness"), shear = p.at("shear_stiffness"),
               bending = p.at("bending_stiffness");
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      join(i, j, i + 1, j, structural);
      join(i, j, i, j + 1, structural);
      join(i, j, i + 1, j + 1, shear);
      join(i, j, i + 1, j - 1, shear);
      join(i, j, i + 2, j, bending);
      join(i, j, i, j + 2, bending);
    }
  }
  const auto cells = static_cast<std::size_t>(count - 1) * static_cast<std::size_t>(count - 1);
  scene.faces.reserve(2 * cells);
  for (int i = 0; i + 1 < count; ++i) {
    for (int j = 0; j + 1 < count; ++j) {
      scene.faces.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      scene.faces.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  }
  return scene;
}

}  // namespace qddot
