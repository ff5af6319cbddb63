// A tight string between two pins that a bow sets in motion. The bow's force on one node is a
// saw-tooth across the string: it rises as the bow takes the string along, and falls where the
// string slips back. Its corners are known times, on which steps end.
#include <algorithm>
#include <cmath>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

constexpr double most_periods = 1e5;

SceneSize size_of_string(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  return {.nodes = count, .springs = count - 1};
}

// From -F to F in the part 1 - slip of each period, and back in the rest.
PiecewiseCubic saw_tooth(double force, double frequency, double slip, double until) {
  std::vector<double> times = {0};
  std::vector<Eigen::Vector3d> forces = {{0, 0, -force}};
  const double periods = std::min(std::ceil(until * frequency), most_periods);
  for (double k = 0; k < periods; ++k) {
    times.insert(times.end(), {(k + 1 - slip) / frequency, (k + 1) / frequency});
    forces.insert(forces.end(), {{0, 0, force}, {0, 0, -force}});
  }
  return PiecewiseCubic::straight(times, forces);
}

Scene draw_string(const GeneratorValues& p) {
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  const auto springs = static_cast<double>(count - 1);
  const double length = p.at("length");
  Scene scene{.until = p.at("until")};
  for (std::size_t i = 0; i < count; ++i) {
    scene.nodes.push_back({.position = {length * static_cast<double>(i) / springs, 0, 0},
                           .mass = p.at("mass") / static_cast<double>(count)});
  }
  scene.nodes.front().pinned = scene.nodes.back().pinned = true;
  const double rest_length = length / springs / (1 + p.at("stretch"));
  for (std::size_t i = 0; i + 1 < count; ++i)
    scene.springs.push_back({{i, i + 1}, {p.at("stiffness"), rest_length}});
  scene.curves = {
      {.tables = {saw_tooth(p.at("force"), p.at("frequency"), p.at("slip"), p.at("until"))}}};
  const auto bowed = static_cast<std::size_t>(std::lround(p.at("place") * springs));
  scene.nodes[std::clamp<std::size_t>(bowed, 1, count - 2)].curve = 0;
  return scene;
}

}  // namespace

Generator bowed_string() {
  return {.name = "bowed_string",
          .summary = "a tight string between two pins, moved by the saw-tooth force of a bow",
          .parameters = {{"nodes", 30, 3, 1e6, "how many nodes", true},
                         {"length", 1, least, most, "between the pins in m"},
                         {"mass", 1, least, most, "of all nodes together in kg"},
                         {"stiffness", 1e6, 0, most, "of each spring in N/m"},
                         {"stretch", 0.05, 0, 100, "strain of the string at rest"},
                         {"place", 0.125, 0.01, 0.99, "of the bow, over the length"},
                         {"force", 5, -most, most, "the largest of the bow in N"},
                         {"frequency", 20, 1e-6, 1e6, "of the bow's slips in Hz"},
                         {"slip", 0.1, 1e-3, 0.999, "the part of a period in which it slips"},
                         {"until", 0.2, least, 1e6, "the end time in s"}},
          .size = size_of_string,
          .draw = draw_string};
}

}  // namespace qddot
