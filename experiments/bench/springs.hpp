#pragma once

#include <algorithm>

#include "qddot/scene/scene.hpp"

namespace qddot::bench {

// Whether the spring moves a node.
inline bool has_free_end(const Scene& scene, const Spring& spring) {
  return !scene.nodes[spring.nodes[0]].pinned || !scene.nodes[spring.nodes[1]].pinned;
}

// Whether a spring of the scene is more than linear.
inline bool has_quartic(const Scene& scene) {
  return std::ranges::any_of(scene.springs,
                             [](const Spring& spring) { return spring.law.quartic != 0; });
}

}  // namespace qddot::bench
