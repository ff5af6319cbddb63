#include "qddot/scene/reduce/part_members.hpp"

#include <algorithm>

#include <boost/pending/disjoint_sets.hpp>

namespace qddot::reduce {

std::vector<PartMembers> parts_of(const std::vector<Node>& nodes,
                                  const std::vector<Spring>& springs) {
  std::vector<std::size_t> rank(nodes.size()), parent(nodes.size());
  boost::disjoint_sets sets(rank.data(), parent.data());
  for (std::size_t i = 0; i < nodes.size(); ++i) sets.make_set(i);
  for (const Spring& spring : springs) {
    const auto [a, b] = spring.nodes;
    if (!nodes[a].pinned && !nodes[b].pinned) sets.union_set(a, b);
  }

  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> number(nodes.size(), none);  // part of each set's root
  std::vector<PartMembers> parts;
  const auto part_of = [&](std::size_t node) -> PartMembers& {
    std::size_t& place = number[sets.find_set(node)];
    if (place == none) {
      place = parts.size();
      parts.emplace_back();
    }
    return parts[place];
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].pinned) part_of(i).nodes.push_back(i);
  }
  for (std::size_t e = 0; e < springs.size(); ++e) {
    const auto [a, b] = springs[e].nodes;
    if (nodes[a].pinned && nodes[b].pinned) continue;
    part_of(nodes[a].pinned ? b : a).springs.push_back(e);
  }
  return parts;
}

std::vector<PartMembers> joined(const std::vector<PartMembers>& parts) {
  if (parts.empty()) return {};
  PartMembers all;
  for (const PartMembers& one : parts) {
    all.nodes.insert(all.nodes.end(), one.nodes.begin(), one.nodes.end());
    all.springs.insert(all.springs.end(), one.springs.begin(), one.springs.end());
  }
  std::ranges::sort(all.nodes);
  std::ranges::sort(all.springs);
  return {all};
}

}  // namespace qddot::reduce
