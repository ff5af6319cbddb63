#include "src/scene/scene_limits.hpp"

#include <fmt/format.h>

#include "src/scene/invalid_input.hpp"

namespace qddot {

void require_within(const SceneLimits& limits, const SceneSize& size, const std::string& source) {
  const auto require = [&](const char* what, std::size_t count, std::size_t most) {
    if (count > most)
      throw InvalidInput(
          fmt::format("{}: {} {} are too many; allowed are up to {}", source, count, what, most));
  };
  require("nodes", size.nodes, limits.nodes);
  require("springs", size.springs, limits.springs);
}

}  // namespace qddot
