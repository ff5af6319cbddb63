#include "qddot/scene/reduce/part_members.hpp"

#include <algorithm>

#include <boost/pending/disjoint_sets.hpp>

namespace qddot::reduce {

std::vector<PartMembers> parts_of(const std::vector<Node>& nodes,
                                  const std::vector<Spring>& springs) {
  // A rank is at most the logarithm of the number of nodes.
  std::vector<unsigned char> rank(nodes.size());
  std::vector<int> parent(nodes.size());
  boost::disjoint_sets sets(rank.data(), parent.data());
  for (int i = 0; i < std::ssize(nodes); ++i) sets.make_set(i);
  for (const Spring& spring : springs) {
    const auto [a, b] = spring.nodes;
    if (!nodes[a].pinned && !nodes[b].pinned)
      sets.union_set(static_cast<int>(a), static_cast<int>(b));
  }

  constexpr int none = -1;
  std::vector<int> number(nodes.size(), none);  // part of each set's root
  int parts = 0;
  const auto part_of = [&](std::size_t node) {
    int& part = number[static_cast<std::size_t>(sets.find_set(static_cast<int>(node)))];
    if (part == none) part = parts++;
    return part;
  };
  std::vector<int> part_of_node(nodes.size(), none);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].pinned) part_of_node[i] = part_of(i);
  }
  const auto part_of_spring = [&](const Spring& spring) {
    return std::max(part_of_node[spring.nodes[0]], part_of_node[spring.nodes[1]]);
  };
  std::vector<std::size_t> nodes_of(static_cast<std::size_t>(parts), 0), springs_of = nodes_of;
  for (const int part : part_of_node) {
    if (part != none) ++nodes_of[static_cast<std::size_t>(part)];
  }
  for (const Spring& spring : springs) {
    if (const int part = part_of_spring(spring); part != none)
      ++springs_of[static_cast<std::size_t>(part)];
  }
  std::vector<PartMembers> all(static_cast<std::size_t>(parts));
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].nodes.reserve(nodes_of[i]);
    all[i].springs.reserve(springs_of[i]);
  }
  for (int i = 0; i < std::ssize(nodes); ++i) {
    if (const int part = part_of_node[static_cast<std::size_t>(i)]; part != none)
      all[static_cast<std::size_t>(part)].nodes.push_back(i);
  }
  for (int e = 0; e < std::ssize(springs); ++e) {
    if (const int part = part_of_spring(springs[static_cast<std::size_t>(e)]); part != none)
      all[static_cast<std::size_t>(part)].springs.push_back(e);
  }
  return all;
}

std::vector<PartMembers> joined(std::vector<PartMembers> parts) {
  if (parts.size() < 2) return parts;
  PartMembers all;
  for (const PartMembers& one : parts) {
    all.nodes.insert(all.nodes.end(), one.nodes.begin(), one.nodes.end());
    all.springs.insert(all.springs.end(), one.springs.begin(), one.springs.end());
  }
  std::ranges::sort(all.nodes);
  std::ranges::sort(all.springs);
  return {std::move(all)};
}

}  // namespace qddot::reduce
