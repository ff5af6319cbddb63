#pragma once

#include "qddot/scene/generators.hpp"

namespace qddot {

// The most that a parameter may be: far beyond any scene, far below overflow.
inline constexpr double most = 1e12;
// The least of a quantity that must not be zero.
inline constexpr double least = 1e-12;

// The size of a scene of one spring and its two ends, for any parameters.
inline SceneSize one_spring(const GeneratorValues&) { return {.nodes = 2, .springs = 1}; }

}  // namespace qddot
