// The chains of Fermi, Pasta, Ulam and Tsingou (Los Alamos report LA-1940, 1955): equal masses of
// 1 kg between two walls on springs of k = 1 N/m, with
//   V = s^2/2 + alpha s^3/3 + beta s^4/4,  s = q_i+1 - q_i.
// The start is the lowest mode at rest, q_i = a sin(pi i/(n + 1)). With alpha or beta small, the
// energy goes to a few higher modes and comes back.
//
// A spring on a line turns over where its length passes zero. All are 100 a long at rest, which
// none loses.
#include <cmath>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

SceneSize size_of_fput(const GeneratorValues& p) {
  const auto n = static_cast<std::size_t>(p.at("masses"));
  return {.nodes = n + 2, .springs = n + 1};
}

Scene draw_fput(const GeneratorValues& p) {
  const auto n = static_cast<std::size_t>(p.at("masses"));
  const double a = p.at("amplitude"), spacing = 100 * std::abs(a);
  const SpringLaw law{
      .stiffness = 1, .rest_length = spacing, .quartic = p.at("beta"), .cubic = p.at("alpha")};
  Scene scene{.dimension = 1, .until = p.at("until")};
  for (std::size_t i = 0; i < n + 2; ++i) {
    const bool is_wall = i == 0 || i == n + 1;
    const double phase = M_PI * static_cast<double>(i) / static_cast<double>(n + 1);
    scene.nodes.push_back(
        {.position = {spacing * static_cast<double>(i) + (is_wall ? 0 : a * std::sin(phase)), 0, 0},
         .mass = 1,
         .pinned = is_wall});
  }
  for (std::size_t e = 0; e <= n; ++e) scene.springs.push_back({{e, e + 1}, law});
  return scene;
}

}  // namespace

Generator fput() {
  return {.name = "fput",
          .summary = "the first chains of Fermi, Pasta, Ulam and Tsingou, cubic and quartic",
          .parameters = {{"masses", 32, 2, 1e6, "how many masses", true},
                         {"alpha", 0.25, -1e3, 1e3, "of the cubic term in N/m^2"},
                         {"beta", 0, 0, 1e3, "of the quartic term in N/m^3"},
                         {"amplitude", 1, least, 1e3, "of the lowest mode in m"},
                         {"until", 200, least, most, "the end time in s"}},
          .size = size_of_fput,
          .draw = draw_fput};
}

}  // namespace qddot
