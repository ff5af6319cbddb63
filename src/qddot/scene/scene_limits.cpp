#include "qddot/scene/scene_limits.hpp"

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot {

double memory_of(const SceneSize& size) {
  return 1000.0 * static_cast<double>(size.nodes) + 370.0 * static_cast<double>(size.springs);
}

void require_within(const SceneLimits& limits, const SceneSize& size, const std::string& source) {
  const auto require = [&](const char* what, std::size_t count, std::size_t most) {
    if (count > most)
      throw InvalidInput(
          fmt::format("{}: {} {} are too many; allowed are up to {}", source, count, what, most));
  };
  require("nodes", size.nodes, limits.nodes);
  require("springs", size.springs, limits.springs);
  if (const double bytes = memory_of(size); bytes > limits.bytes) {
    throw InvalidInput(
        fmt::format("{}: {} nodes and {} springs take about {:.2g} GB of memory, and {:.2g} GB are "
                    "free; allowed are scenes that fit in there",
                    source, size.nodes, size.springs, 1e-9 * bytes, 1e-9 * limits.bytes));
  }
}

}  // namespace qddot
