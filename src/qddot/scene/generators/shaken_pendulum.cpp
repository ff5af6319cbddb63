// An elastic pendulum in a plane whose support shakes up and down, by a sin(W t). Of small angles
// and a stiff spring, the angle obeys Mathieu's equation
//   angle'' + (g - a W^2 sin(W t))/l angle = 0
// It grows from any small push where W is near 2 w/n, w = sqrt(g/l), n = 1, 2, ... And it stays
// upright where a W is above sqrt(2 g l) (Stephenson 1908; Kapitza 1951).
#include <cmath>
#include <numbers>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {

Generator shaken_pendulum() {
  return {
      .name = "shaken_pendulum",
      .summary = "an elastic pendulum whose support shakes up and down",
      .parameters = {{"mass", 1, least, most, "the mass in kg"},
                     {"stiffness", 1e5, 0, most, "k in N/m"},
                     {"length", 1, least, most, "l in m, at rest and at t = 0"},
                     {"angle", 0.02, -4, 4, "the angle from the vertical at t = 0 in rad"},
                     {"gravity", 9.81, -most, most, "g downwards in m/s^2"},
                     {"amplitude", 0.05, -most, most, "a of the support in m"},
                     {"frequency", 1, 0, most, "W/(2 pi) of the support in Hz"},
                     {"until", 10, least, most, "the end time in s"}},
      .size = one_spring,
      .draw = [](const GeneratorValues& p) {
        const double l = p.at("length"), angle = p.at("angle");
        Scene scene{.dimension = 2, .gravity = {0, -p.at("gravity"), 0}, .until = p.at("until")};
        scene.curves = {
            {.harmonics = {
                 {{0, p.at("amplitude"), 0}, 2 * std::numbers::pi * p.at("frequency"), 0}}}};
        scene.nodes = {
            {.pinned = true, .curve = 0},
            {.position = {l * std::sin(angle), -l * std::cos(angle), 0}, .mass = p.at("mass")}};
        scene.springs = {{{0, 1}, {.stiffness = p.at("stiffness"), .rest_length = l}}};
        return scene;
      }};
}

}  // namespace qddot
