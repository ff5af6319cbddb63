#include "experiments/crossover/stiff_scenes.hpp"

#include "qddot/scene/generators.hpp"

namespace qddot::crossover {
namespace {

// As the generators have them [m/s^2].
constexpr double gravity = 9.81;

Scene drawn(const char* generator, const GeneratorValues& values, const std::string& name) {
  Scene scene = generate(*find_generator(generator), values, name);
  scene.name = name;
  return scene;
}

Scene frame(int nodes, double until, double ratio) {
  constexpr double cloth = 1000;  // [N/m]
  Scene scene = drawn("framed_cloth",
                      {{"nodes", nodes},
                       {"until", until},
                       {"structural_stiffness", cloth},
                       {"frame_stiffness", cloth * ratio}},
                      "frame");
  if (ratio == 1) scene.stiff_above.reset();
  return scene;
}

Scene hem(int nodes, double until, double ratio) {
  constexpr double cloth = 1000;  // [N/m]
  Scene scene = drawn("hemmed_cloth",
                      {{"nodes", nodes},
                       {"until", until},
                       {"structural_stiffness", cloth},
                       {"hem_stiffness", cloth * ratio}},
                      "hem");
  if (ratio == 1) scene.stiff_above.reset();
  return scene;
}

Scene whole(int nodes, double until, double ratio) {
  constexpr double mass = 0.5, side = 1;  // [kg], [m]
  const double k = ratio * mass * gravity / side;
  return drawn("cloth",
               {{"nodes", nodes},
                {"until", until},
                {"mass", mass},
                {"side", side},
                {"structural_stiffness", k},
                {"shear_stiffness", k / 2},
                {"bending_stiffness", k / 10}},
               "whole");
}

Scene chain(int nodes, double until, double ratio) {
  constexpr double mass = 1, length = 1;  // [kg], [m]
  const double soft = 1000 * (nodes - 1) * mass * gravity / length;
  Scene scene = drawn(
      "chain",
      {{"nodes", nodes}, {"until", until}, {"mass", mass}, {"length", length}, {"stiffness", soft}},
      "chain");
  const std::size_t count = scene.springs.size();
  for (std::size_t i = count / 3; i < count - count / 3; ++i) {
    scene.springs[i].law.stiffness = soft * ratio;
  }
  if (ratio > 1) scene.stiff_above = soft + 0.5 * (soft * ratio - soft);
  return scene;
}

}  // namespace

const std::vector<StiffFamily>& stiff_families() {
  static const std::vector<StiffFamily> all = {
      {"frame", "a soft cloth in a stiff frame", 12, 0.25, frame},
      {"hem", "a soft cloth with a stiff hem", 12, 0.25, hem},
      {"whole", "a cloth that is stiff against its weight", 12, 0.25, whole},
      {"chain", "a chain with a stiff middle third", 30, 0.25, chain}};
  return all;
}

}  // namespace qddot::crossover
