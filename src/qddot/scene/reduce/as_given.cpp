#include "qddot/scene/reduce/as_given.hpp"

#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

namespace qddot::reduce {

AsGiven::AsGiven(std::shared_ptr<const System> system, State initial, int dimension)
    : system_(std::move(system)), initial_(std::move(initial)), dimension_(dimension) {
  if (!system_) throw std::invalid_argument("there is no system");
  const Index n = system_->size();
  if (dimension_ < 1 || dimension_ > 3 || n % dimension_ != 0) {
    throw std::invalid_argument(fmt::format(
        "dimension {} is not allowed; it is 1, 2 or 3 and divides the {} unknowns", dimension_, n));
  }
  if (initial_.q.size() != n || initial_.v.size() != n) {
    throw std::invalid_argument(
        fmt::format("the start has {} positions and {} velocities, and the system {} unknowns",
                    initial_.q.size(), initial_.v.size(), n));
  }
}

void AsGiven::expand(const State& state, bool, std::vector<Node>& nodes) const {
  nodes.resize(static_cast<std::size_t>(system_->size() / dimension_));
  Index at = 0;
  for (Node& node : nodes) {
    node.position.head(dimension_) = state.q.segment(at, dimension_);
    node.velocity.head(dimension_) = state.v.segment(at, dimension_);
    node.mass = system_->mass()[at];
    at += dimension_;
  }
}

std::vector<std::size_t> AsGiven::massless_nodes() const {
  std::vector<std::size_t> massless;
  const auto per_node = static_cast<std::size_t>(dimension_);
  for (Index i = 0; i < system_->size(); ++i) {
    const std::size_t node = static_cast<std::size_t>(i) / per_node;
    const bool is_known = !massless.empty() && massless.back() == node;
    if (system_->mass()[i] == 0 && !is_known) massless.push_back(node);
  }
  return massless;
}

std::vector<std::vector<std::size_t>> AsGiven::nodes_by_part() const {
  std::vector<std::size_t> all(static_cast<std::size_t>(system_->size() / dimension_));
  std::iota(all.begin(), all.end(), 0);
  return {all};
}

}  // namespace qddot::reduce
