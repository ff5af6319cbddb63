// A compressed column in the plane: nodes in a row between two pins. All springs are compressed to
// l = `compression` l0, and the column is bent by a first half-sine of amplitude `bend`.
//
// A straight column (bend = 0) stands in unstable equilibrium. A compressed spring has the
// transverse stiffness tau/l = k (1 - l0/l) < 0; across, N free nodes between two walls have the
// chain's matrix. So small motions across, of masses m and shapes sin(j pi i/(N + 1)), grow as
// e^(sqrt(lambda_j) t) with
//   lambda_j = (4 k/m) (l0/l - 1) sin^2(j pi / (2 (N + 1))),  j = 1, ..., N.
// M - h^2 K is singular where h^2 lambda_j = 1. Nodes vibrate along the column with
//   w_j^2 = (4 k/m) sin^2(j pi / (2 (N + 1))).
#include <cmath>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

SceneSize size_of_strut(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  return {.nodes = count, .springs = count - 1};
}

Scene draw_strut(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  const double spacing = p.at("length") / static_cast<double>(count - 1);
  Scene scene{.dimension = 2, .until = p.at("until")};
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_end = i == 0 || i + 1 == count;
    const double x = spacing * static_cast<double>(i);
    const double y = is_end ? 0 : p.at("bend") * std::sin(M_PI * x / p.at("length"));
    scene.nodes.push_back({.position = {x, y, 0}, .mass = p.at("mass"), .pinned = is_end});
  }
  for (std::size_t i = 0; i + 1 < count; ++i) {
    scene.springs.push_back({{i, i + 1}, {p.at("stiffness"), spacing / p.at("compression")}});
  }
  return scene;
}

}  // namespace

Generator strut() {
  return {.name = "strut",
          .summary = "a compressed column between two pins in the plane, which buckles",
          .parameters = {{"nodes", 12, 3, 1e7, "how many nodes, the two pins among them", true},
                         {"length", 1, least, most, "between the pins in m"},
                         {"mass", 0.1, least, most, "of each node in kg"},
                         {"stiffness", 1000, 0, most, "of each spring in N/m"},
                         {"compression", 0.9, 1e-3, 1,
                          "length over rest length of the springs when straight"},
                         {"bend", 1e-3, -most, most, "sideways in the middle at t = 0 in m"},
                         {"until", 1, least, most, "the end time in s"}},
          .size = size_of_strut,
          .draw = draw_strut};
}

}  // namespace qddot
