#include "qddot/scene/settle.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot {
namespace {

double diagonal(const std::vector<Node>& nodes) {
  Eigen::AlignedBox3d box;
  for (const Node& node : nodes) box.extend(node.position);
  const double size = box.isEmpty() ? 0 : box.diagonal().norm();
  return size > 0 ? size : 1;  // a single point has no scale of its own
}

}  // namespace

Equilibrium equilibrium_of(const Model& scene) {
  const State& start = scene.initial();
  const std::vector<Node> drawn = scene.expand(start);
  Equilibrium rest = find_equilibrium(scene.system(), start.q, diagonal(drawn));
  if (rest.outcome == Equilibrium::Outcome::reached) return rest;
  const std::vector<Node> nodes = scene.expand({0, rest.q, start.v});
  const auto moved = [&](std::size_t i) { return (nodes[i].position - drawn[i].position).norm(); };
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (moved(i) > moved(farthest)) farthest = i;
  }
  if (!nodes.empty()) {
    rest.message += fmt::format(" (node {} moved by {:.3g} m)", farthest, moved(farthest));
  }
  return rest;
}

Scene settled(const Scene& scene, const std::string& source) {
  const Model model(scene, Reductions::all_directions());
  const Equilibrium rest = equilibrium_of(model);
  const std::vector<Node> nodes = model.expand({0, rest.q, model.initial().v});
  if (rest.outcome != Equilibrium::Outcome::reached) {
    throw InvalidInput(fmt::format("{}: {}", source, rest.message));
  }
  Scene result = scene;
  result.starts_at_equilibrium = false;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].pinned) result.nodes[i].position = nodes[i].position;
  }
  return result;
}

std::optional<Scene> settled_if_asked(const Scene& scene, const std::string& source) {
  if (!scene.starts_at_equilibrium) return {};
  return settled(scene, source);
}

}  // namespace qddot
