#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace qddot {

// How many nodes and springs a scene has.
struct SceneSize {
  std::size_t nodes = 0, springs = 0;
};

// The memory that a scene of that size, its reduction and what passes meanwhile take at most
// [bytes]: measured on chains, cloths and lattices. A method's own comes on top of it.
double memory_of(const SceneSize& size);

// How many a scene may have at most, and what memory it may take [bytes].
struct SceneLimits {
  std::size_t nodes = 10'000'000, springs = 100'000'000;
  double bytes = std::numeric_limits<double>::infinity();
};

// Throws InvalidInput, in a sentence that starts with `source`, for a size beyond the limits. Asked
// before memory is taken for a scene of that size.
void require_within(const SceneLimits& limits, const SceneSize& size, const std::string& source);

}  // namespace qddot
