#pragma once

#include <cstdint>
#include <string>

#include "qddot/scene/scene.hpp"

namespace qddot::advice_study {

// A question that somebody may bring: this scene, up to then, this accurately.
struct Case {
  std::uint64_t seed = 0;
  std::string kind;  // of scene
  Scene scene{};
  double until = 0;     // [s]
  double accuracy = 0;  // of positions at the end, relative
};

// The case of that seed, the same on every machine. Kinds: each generator with drawn parameters,
// chains and cloths whose springs differ by up to 1e8 in stiffness, compressed and mirrored ones,
// surfaces of triangles, and random networks in 1, 2 and 3 dimensions. Sizes are drawn by their
// logarithm from 1 to 10^4 nodes; runs from 100 to 10^5 steps of Verlet's method at its limit, and
// at most some 10^8 springs by steps; accuracies from 1e-1 to 1e-10.
Case drawn_case(std::uint64_t seed);

}  // namespace qddot::advice_study
