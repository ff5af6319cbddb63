#pragma once

#include <optional>
#include <string>

#include "qddot/analysis/equilibrium.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

// The stable equilibrium that is reached downhill from the scene's initial positions. The size of
// the scene is the diagonal of the box around its nodes. A failure's sentence names the node that
// moved farthest, which belongs to the part that falls. No more than Reductions::all_directions()
// may have reduced the scene: rest may lie where a reduced motion never comes.
Equilibrium equilibrium_of(const Model& scene);

// The scene with its nodes at that equilibrium and its velocities as drawn; it no longer asks to
// start there. Throws InvalidInput if there is no equilibrium or none is reached. The sentence
// starts with `source`.
Scene settled(const Scene& scene, const std::string& source);

// The scene settled, if it asks to start at its equilibrium; nothing if it starts as drawn. Throws
// as settled does.
std::optional<Scene> settled_if_asked(const Scene& scene, const std::string& source);

}  // namespace qddot
