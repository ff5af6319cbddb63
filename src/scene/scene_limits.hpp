#pragma once

#include <cstddef>
#include <string>

namespace qddot {

// How many nodes and springs a scene has.
struct SceneSize {
  std::size_t nodes = 0, springs = 0;
};

// How many a scene may have at most; by default what some 5 GB of memory hold.
struct SceneLimits {
  std::size_t nodes = 10'000'000, springs = 100'000'000;
};

// Throws InvalidInput, in a sentence that starts with `source`, for a size beyond the limits. Asked
// before memory is taken for a scene of that size.
void require_within(const SceneLimits& limits, const SceneSize& size, const std::string& source);

}  // namespace qddot
