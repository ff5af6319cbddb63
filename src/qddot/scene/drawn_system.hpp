#pragma once

#include <memory>

#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

// The forces of a scene as it is drawn, with nothing left out. Its unknowns are the coordinates of
// all nodes in the scene's order, `dimension` for each. Pinned nodes are held: their forces, and
// their rows and columns of K, are zero, and their weights do not count in V.
std::unique_ptr<System> drawn_system(const Scene& scene);

}  // namespace qddot
