// The lecture's first example, a 1D spring of zero rest length on a wall: m x'' = -k x. Its closed
// form by exp(At) is x(t) = x0 cos(w t), w = sqrt(k/m).
#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {

Generator oscillator() {
  return {.name = "oscillator",
          .summary = "one mass on a 1D spring of zero rest length",
          .parameters = {{"mass", 1, least, most, "the mass in kg"},
                         {"stiffness", 100, 0, most, "k in N/m"},
                         {"position", 1, -most, most, "x at t = 0 in m"},
                         {"velocity", 0, -most, most, "v at t = 0 in m/s"},
                         {"until", 2, least, most, "the end time in s"}},
          .size = one_spring,
          .draw = [](const GeneratorValues& p) {
            Scene scene{.dimension = 1, .until = p.at("until")};
            scene.nodes = {{.pinned = true},
                           {.position = {p.at("position"), 0, 0},
                            .velocity = {p.at("velocity"), 0, 0},
                            .mass = p.at("mass")}};
            scene.springs = {{{0, 1}, {.stiffness = p.at("stiffness")}}};
            return scene;
          }};
}

}  // namespace qddot
