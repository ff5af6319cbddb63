// The lecture's single spring in 3D: a mass tied to the origin, thrown sideways. The force is
// central, so energy and angular momentum stay, and the motion stays in a plane that is none of the
// coordinate planes. The orbit is an ellipse if rest_length = 0, otherwise a rosette.
#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {

Generator orbit() {
  return {.name = "orbit",
          .summary = "one mass on a 3D spring, circling its pinned end",
          .parameters = {{"mass", 1, least, most, "the mass in kg"},
                         {"stiffness", 100, 0, most, "k in N/m"},
                         {"rest_length", 1, 0, most, "l0 in m"},
                         {"radius", 1.2, least, most, "the distance at t = 0 in m"},
                         {"speed", 3, 0, most, "the speed across the spring at t = 0 in m/s"},
                         {"until", 2, least, most, "the end time in s"}},
          .size = one_spring,
          .draw = [](const GeneratorValues& p) {
            Scene scene{.until = p.at("until")};
            scene.nodes = {{.pinned = true},
                           {.position = {p.at("radius"), 0, 0},
                            .velocity = p.at("speed") * Eigen::Vector3d(0, 0.8, 0.6),
                            .mass = p.at("mass")}};
            scene.springs = {
                {{0, 1}, {.stiffness = p.at("stiffness"), .rest_length = p.at("rest_length")}}};
            return scene;
          }};
}

}  // namespace qddot
