#pragma once

#include <vector>

#include "qddot/scene/generators.hpp"

namespace qddot {

// A square cloth of N x N nodes with structural, shear and bending springs (Provot, Graphics
// Interface 1995), pinned at the two corners of one side, flat and horizontal: for every generator
// that draws one. Node (i, j) is number i N + j. Two faces a cell.
std::vector<GeneratorParameter> cloth_parameters();
SceneSize cloth_size(const GeneratorValues& values);
Scene draw_cloth(const GeneratorValues& values);

}  // namespace qddot
