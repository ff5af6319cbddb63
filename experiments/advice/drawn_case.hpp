#pragma once

#include <cstdint>
#include <string>

#include "qddot/scene/scene.hpp"

namespace qddot::judged_advice {

// A question that somebody may bring: this scene, up to then, this accurately.
struct Case {
  std::uint64_t seed = 0;
  std::string kind;  // of scene
  Scene scene{};
  double until = 0;     // [s]
  double accuracy = 0;  // of positions at the end, relative
};

// The case of that seed, the same on every machine. Its scene is of one of these kinds:
// - a generator's scene with drawn parameters,
// - a chain or cloth whose springs differ by up to 1e8 in stiffness,
// - a compressed or mirrored scene,
// - a surface of triangles,
// - a random network in 1, 2 or 3 dimensions.
// Sizes (1 to 10^4 nodes), run lengths and accuracies (1e-1 to 1e-10) are drawn by their logarithm.
// A run has 100 to 10^5 steps of Verlet's method at its limit; its steps times springs are at most
// about 10^8.
Case drawn_case(std::uint64_t seed);

}  // namespace qddot::judged_advice
