#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace qddot {

// The number of nodes and springs of a scene.
struct SceneSize {
  std::size_t nodes = 0, springs = 0;
};

// The memory [bytes] that a scene of that size takes at most, with its reduction and temporary
// data; measured on chains, cloths and lattices. A method's own memory is not included.
double memory_of(const SceneSize& size);

// The most nodes, springs and memory [bytes] that a scene may take.
struct SceneLimits {
  std::size_t nodes = 10'000'000, springs = 100'000'000;
  double bytes = std::numeric_limits<double>::infinity();
};

// Throws InvalidInput, in a sentence that starts with `source`, for a size beyond the limits. Call
// before memory is taken for such a scene.
void require_within(const SceneLimits& limits, const SceneSize& size, const std::string& source);

}  // namespace qddot
