#pragma once

#include "qddot/scene/generators.hpp"

namespace qddot {

// The size of a scene of one spring and its two ends, for any parameters.
inline SceneSize one_spring(const GeneratorValues&) { return {.nodes = 2, .springs = 1}; }

}  // namespace qddot
