// Two free masses on one spring: the centre of mass moves uniformly, the spring vibrates and
// rotates about it. The frequency at small amplitude without rotation is sqrt(k/mu) with the
// reduced mass mu = m1 m2 / (m1 + m2).
#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {

Generator pair() {
  return {
      .name = "pair",
      .summary = "two free masses on a spring, vibrating and rotating",
      .parameters = {{"mass_1", 1, least, most, "the first mass in kg"},
                     {"mass_2", 2, least, most, "the second mass in kg"},
                     {"stiffness", 100, 0, most, "k in N/m"},
                     {"rest_length", 1, 0, most, "l0 in m"},
                     {"stretch", 1.1, least, most, "length / l0 at t = 0 (length in m if l0 = 0)"},
                     {"spin", 2, -most, most, "angular velocity at t = 0 in rad/s"},
                     {"until", 2, least, most, "the end time in s"}},
      .size = one_spring,
      .draw = [](const GeneratorValues& p) {
        const double m1 = p.at("mass_1"), m2 = p.at("mass_2"), l0 = p.at("rest_length");
        const double length = p.at("stretch") * (l0 > 0 ? l0 : 1);
        const double x1 = -length * m2 / (m1 + m2), x2 = length * m1 / (m1 + m2);
        Scene scene{.until = p.at("until")};
        scene.nodes = {{.position = {x1, 0, 0}, .velocity = {0, p.at("spin") * x1, 0}, .mass = m1},
                       {.position = {x2, 0, 0}, .velocity = {0, p.at("spin") * x2, 0}, .mass = m2}};
        scene.springs = {{{0, 1}, {.stiffness = p.at("stiffness"), .rest_length = l0}}};
        return scene;
      }};
}

}  // namespace qddot
