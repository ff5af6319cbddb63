#include "src/scene/reduce.hpp"

#include "src/model/mass_spring.hpp"

namespace qddot {
namespace {

constexpr int pinned = -1;

// The number of each node among the free ones, or `pinned`.
std::vector<int> free_numbers(const std::vector<Node>& nodes) {
  std::vector<int> number;
  int next = 0;
  for (const Node& node : nodes) number.push_back(node.pinned ? pinned : next++);
  return number;
}

void add_spring(Network& network, const Scene& scene, const std::vector<int>& number,
                const Spring& spring) {
  const auto [a, b] = spring.nodes;
  const auto& [at_a, at_b] = std::tie(scene.nodes[a].position, scene.nodes[b].position);
  if (number[a] != pinned && number[b] != pinned) {
    network.links.push_back({number[a], number[b], spring.law});
  } else if (number[a] != pinned) {
    network.anchors.push_back({number[a], at_b, spring.law});
  } else if (number[b] != pinned) {
    network.anchors.push_back({number[b], at_a, spring.law});
  } else {
    network.constant_energy += spring.law.energy((at_b - at_a).norm());
  }
}

}  // namespace

ReducedScene::ReducedScene(const Scene& scene) : nodes_(scene.nodes), dimension_(scene.dimension) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].pinned) free_.push_back(i);
  }
  const auto count = std::ssize(free_);

  Network network{.dimension = scene.dimension, .gravity = scene.gravity};
  network.node_mass.resize(count);
  initial_.q.resize(dimension_ * count);
  initial_.v.resize(dimension_ * count);
  for (Index i = 0; i < count; ++i) {
    const Node& node = nodes_[free_[i]];
    network.node_mass[i] = node.mass;
    initial_.q.segment(dimension_ * i, dimension_) = node.position.head(dimension_);
    initial_.v.segment(dimension_ * i, dimension_) = node.velocity.head(dimension_);
  }
  const auto number = free_numbers(nodes_);
  for (const Spring& spring : scene.springs) add_spring(network, scene, number, spring);
  system_ = make_mass_spring(network);
}

std::vector<Node> ReducedScene::expand(const State& state) const {
  std::vector<Node> nodes = nodes_;
  for (Node& node : nodes) {
    if (node.pinned) node.velocity.setZero();
  }
  for (Index i = 0; i < std::ssize(free_); ++i) {
    Node& node = nodes[free_[i]];
    node.position.head(dimension_) = state.q.segment(dimension_ * i, dimension_);
    node.velocity.head(dimension_) = state.v.segment(dimension_ * i, dimension_);
  }
  return nodes;
}

}  // namespace qddot
