// An elastic pendulum in 3D: a mass under gravity on a spring, let go to the side with a push
// across. Its two frequencies, sqrt(k/m) along the spring and about sqrt(g/l) across, exchange
// energy.
#include <cmath>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {

Generator pendulum() {
  return {.name = "pendulum",
          .summary = "one mass on an elastic pendulum in 3D",
          .parameters = {{"mass", 1, least, most, "the mass in kg"},
                         {"stiffness", 1000, 0, most, "k in N/m"},
                         {"rest_length", 1, 0, most, "l0 in m"},
                         {"length", 1, least, most, "the length at t = 0 in m"},
                         {"angle", 1, -4, 4, "the angle from the vertical at t = 0 in rad"},
                         {"speed", 0.5, -most, most, "the speed out of the plane at t = 0 in m/s"},
                         {"gravity", 9.81, -most, most, "g along -z in m/s^2"},
                         {"until", 2, least, most, "the end time in s"}},
          .size = one_spring,
          .draw = [](const GeneratorValues& p) {
            const double l = p.at("length"), angle = p.at("angle");
            Scene scene{.gravity = {0, 0, -p.at("gravity")}, .until = p.at("until")};
            scene.nodes = {{.pinned = true},
                           {.position = {l * std::sin(angle), 0, -l * std::cos(angle)},
                            .velocity = {0, p.at("speed"), 0},
                            .mass = p.at("mass")}};
            scene.springs = {
                {{0, 1}, {.stiffness = p.at("stiffness"), .rest_length = p.at("rest_length")}}};
            return scene;
          }};
}

}  // namespace qddot
