#pragma once

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

#include "qddot/model/grouped.hpp"
#include "qddot/scene/reduce/drawn_part.hpp"

namespace qddot::reduce {

// Finds the springs of a part by their ends.
class SpringEnds {
 public:
  explicit SpringEnds(const DrawnPart& drawn)
      : springs_(drawn.springs),
        by_low_(static_cast<int>(drawn.x.size()), springs_.size(),
                [&](int e) { return std::min(springs_.ends(e)[0], springs_.ends(e)[1]); }),
        any_shared_(any_share_both_ends(by_low_, [&](int e) { return high(e); })) {
    for (int node = 0; node < by_low_.groups(); ++node) {
      if (by_low_[node].size() > few)
        std::ranges::sort(by_low_.numbers(node), {}, [&](int e) { return high(e); });
    }
  }

  // Whether two springs join the same two nodes.
  bool any_shared() const { return any_shared_; }

  // The first spring between two nodes, or -1.
  int first_between(int a, int b) const {
    const std::span<const int> near = near_to(a, b);
    const auto found = std::ranges::find(near, std::max(a, b), [&](int e) { return high(e); });
    return found == near.end() ? -1 : *found;
  }

  // Sets `found` to the springs between two nodes, shortest rest length first.
  void between(int a, int b, std::vector<int>& found) const {
    found.clear();
    for (const int e : near_to(a, b)) {
      if (high(e) == std::max(a, b)) found.push_back(e);
    }
    if (found.size() > 1) std::ranges::sort(found, {}, [&](int e) { return key(e); });
  }

 private:
  // Springs at one node are searched one by one up to so many; more are sorted by their other ends.
  static constexpr std::size_t few = 16;

  // Springs with the lower of two ends, all those between both among them, and few others.
  std::span<const int> near_to(int a, int b) const {
    const std::span<const int> all = by_low_[std::min(a, b)];
    if (all.size() <= few) return all;
    const auto high_of = [&](int e) { return high(e); };
    return {std::ranges::lower_bound(all, std::max(a, b), {}, high_of),
            std::ranges::upper_bound(all, std::max(a, b), {}, high_of)};
  }
  int high(int e) const { return std::max(springs_.ends(e)[0], springs_.ends(e)[1]); }
  std::tuple<double, double, double, double, Holds, bool> key(int e) const {
    const auto [ends, law, holds, stiff] = springs_[e];
    return {law.rest_length, law.stiffness, law.quartic, law.damping, holds, law.rigid};
  }

  const PartSprings& springs_;
  Grouped by_low_;
  bool any_shared_;
};

// The neighbours of each node of a part, in the order of the springs.
class Neighbours {
 public:
  explicit Neighbours(const DrawnPart& drawn)
      : springs_(drawn.springs),
        // Spring e is met from its first end by number 2 e, from its second by the next.
        meetings_(static_cast<int>(drawn.nodes.size()), 2 * springs_.size(),
                  [&](int k) { return springs_.ends(k / 2)[at(k % 2)]; }) {}

  // Whether holds(neighbour) for each neighbour of the node.
  template <class Holds>
  bool all_of(int node, const Holds& holds) const {
    return std::ranges::all_of(meetings_[node], [&](int k) { return holds(other_end(k)); });
  }
  int other_end(int k) const { return springs_.ends(k / 2)[at(1 - k % 2)]; }

  // The nodes breadth-first from one of them, so that each follows one of its neighbours if
  // possible.
  std::vector<int> along_springs(int start = 0) const {
    const int nodes = meetings_.groups();
    std::vector<int> order;
    std::vector<bool> is_seen(at(nodes), false);
    for (int i = 0; i < nodes; ++i) {
      const int first = (start + i) % nodes;
      if (is_seen[at(first)]) continue;
      is_seen[at(first)] = true;
      order.push_back(first);
      for (std::size_t reached = order.size() - 1; reached < order.size(); ++reached) {
        for (const int k : meetings_[order[reached]]) {
          const int next = other_end(k);
          if (!is_seen[at(next)]) order.push_back(next);
          is_seen[at(next)] = true;
        }
      }
    }
    return order;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  const PartSprings& springs_;
  Grouped meetings_;
};

}  // namespace qddot::reduce
