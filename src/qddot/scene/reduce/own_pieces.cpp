#include <stdexcept>

#include <fmt/format.h>

#include "qddot/scene/reduce/pieces.hpp"

namespace qddot::reduce {

Pieces pieces_of(std::shared_ptr<const System> system, State initial, int dimension) {
  if (!system) throw std::invalid_argument("there is no system");
  const Index n = system->size();
  if (dimension < 1 || dimension > 3 || n % dimension != 0) {
    throw std::invalid_argument(fmt::format(
        "dimension {} is not allowed; it is 1, 2 or 3 and divides the {} unknowns", dimension, n));
  }
  if (initial.q.size() != n || initial.v.size() != n) {
    throw std::invalid_argument(
        fmt::format("the start has {} positions and {} velocities, and the system {} unknowns",
                    initial.q.size(), initial.v.size(), n));
  }
  std::vector<Node> nodes(static_cast<std::size_t>(n / dimension));
  Index first = 0;
  for (Node& node : nodes) {
    node.mass = system->mass()[first];
    first += dimension;
  }
  return {.is_own = true,
          .nodes = std::move(nodes),
          .dimension = dimension,
          .system = std::move(system),
          .initial = std::move(initial)};
}

}  // namespace qddot::reduce
