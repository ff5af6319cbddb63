#pragma once

#include <vector>

#include "qddot/scene/generators.hpp"

namespace qddot {

// A square cloth of N x N nodes, flat and horizontal, for every generator that draws one. It has
// structural, shear and bending springs (Provot, Graphics Interface 1995) and two faces a cell. The
// two corners of one side are pinned. Node (i, j) is number i N + j.
std::vector<GeneratorParameter> cloth_parameters();
SceneSize cloth_size(const GeneratorValues& values);
Scene draw_cloth(const GeneratorValues& values);

}  // namespace qddot
