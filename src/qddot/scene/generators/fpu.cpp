// The chain of Fermi, Pasta and Ulam in the form of Hairer, Lubich and Wanner (Geometric Numerical
// Integration, I.5.1 and XIII). It has m stiff harmonic springs that alternate with m + 1 soft
// quartic ones, on a line between two walls. The displacements q of the 2m masses of 1 kg,
// q_0 = q_2m+1 = 0, have
//   H = 1/2 sum p_i^2 + w^2/4 sum_1^m (q_2i - q_2i-1)^2 + sum_0^m (q_2i+1 - q_2i)^4,
// which is springs of k = w^2/2 and of c = 4 (V = k/2 s^2 + c/4 s^4). Two masses on a stiff spring
// alone vibrate at w. The coordinates of the pairs are
//   x_0,i = (q_2i + q_2i-1)/sqrt 2,  x_1,i = (q_2i - q_2i-1)/sqrt 2.
// The start is x_0,1 = x'_0,1 = 1, x_1,1 = 1/w, x'_1,1 = 1, all else zero. Then the stiff springs'
// energies I_i = 1/2 (x'_1,i^2 + w^2 x_1,i^2) are 1, 0, ..., 0, and
//   H = 2 + 3/w^2 + 1/(2 w^4).
// I_1 goes over to the other springs in times of the order of w, while the sum of all stays near 1.
//
// The force of a spring on a line jumps when its ends pass through each other. So all springs are
// 10 m long at rest, which none ever loses. No term of H exceeds H: a soft spring changes by at
// most H^1/4 and a stiff one by 2 sqrt(H)/w. These are less than 1.6 m and 4.7 m from w = 1 on.
// Nothing depends on the 10 m as long as they are enough.
#include <cmath>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

constexpr double node_spacing = 10;  // [m]

SceneSize size_of_fpu(const GeneratorValues& p) {
  const auto m = static_cast<std::size_t>(p.at("stiff_springs"));
  return {.nodes = 2 * m + 2, .springs = 2 * m + 1};
}

Scene draw_fpu(const GeneratorValues& p) {
  const double w = p.at("frequency");
  const SpringLaw stiff{.stiffness = 0.5 * w * w, .rest_length = node_spacing};
  const SpringLaw soft{.rest_length = node_spacing, .quartic = 4};
  Scene scene{.dimension = 1, .until = p.at("until"), .stiff_above = 0.5 * stiff.stiffness};
  const auto [nodes, springs] = size_of_fpu(p);
  for (std::size_t i = 0; i < nodes; ++i) {
    scene.nodes.push_back({.position = {node_spacing * static_cast<double>(i), 0, 0},
                           .mass = 1,
                           .pinned = i == 0 || i + 1 == nodes});
  }
  for (std::size_t e = 0; e < springs; ++e) {
    scene.springs.push_back({{e, e + 1}, e % 2 == 0 ? soft : stiff});
  }
  // q_1 and q_2 are (x_0,1 -+ x_1,1)/sqrt 2, velocities likewise.
  Node &left = scene.nodes[1], &right = scene.nodes[2];
  left.position.x() += (1 - 1 / w) / std::sqrt(2);
  right.position.x() += (1 + 1 / w) / std::sqrt(2);
  right.velocity.x() = 2 / std::sqrt(2);
  return scene;
}

}  // namespace

Generator fpu() {
  return {.name = "fpu",
          .summary = "the Fermi-Pasta-Ulam chain: stiff springs that exchange energy slowly",
          .parameters = {{"stiff_springs", 3, 1, 1e6, "how many stiff springs", true},
                         {"frequency", 50, 1, 1e6, "w of a pair on a stiff spring in rad/s"},
                         {"until", 200, least, most, "the end time in s"}},
          .size = size_of_fpu,
          .draw = draw_fpu};
}

}  // namespace qddot
