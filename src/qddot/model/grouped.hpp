#pragma once

#include <numeric>
#include <span>
#include <vector>

namespace qddot {

// Numbers 0 ... count - 1 in groups, by one counting sort: linear time, and one array for all. Each
// group keeps the order of its numbers. Examples: springs by their lower end, nodes by their part.
class Grouped {
 public:
  // The group of a number that is left out.
  static constexpr int none = -1;

  // `group_of(k)`: the group of number k, from 0 to groups - 1, or none. It is called twice.
  template <class GroupOf>
  Grouped(int groups, int count, const GroupOf& group_of)
      : begin_(static_cast<std::size_t>(groups) + 1, 0) {
    for (int k = 0; k < count; ++k) {
      if (const int group = group_of(k); group != none) ++begin_[at(group)];
    }
    std::exclusive_scan(begin_.begin(), begin_.end(), begin_.begin(), 0);
    numbers_.resize(at(begin_.back()));
    // Each begin moves to the group's end, where the next one begins, and back at last.
    for (int k = 0; k < count; ++k) {
      if (const int group = group_of(k); group != none) numbers_[at(begin_[at(group)]++)] = k;
    }
    for (int group = groups; group > 0; --group) begin_[at(group)] = begin_[at(group) - 1];
    begin_.front() = 0;
  }

  int groups() const { return static_cast<int>(begin_.size()) - 1; }
  // The numbers of a group, to be put into another order.
  std::span<int> numbers(int group) {
    return {numbers_.data() + begin_[at(group)], numbers_.data() + begin_[at(group) + 1]};
  }
  std::span<const int> operator[](int group) const {
    return {numbers_.data() + begin_[at(group)], numbers_.data() + begin_[at(group) + 1]};
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::vector<int> begin_, numbers_;
};

// Whether two springs join the same two nodes. The springs are in groups by their lower ends;
// `high_of(e)`: the other end of spring e, below the number of groups.
template <class HighOf>
bool any_share_both_ends(const Grouped& by_low, const HighOf& high_of) {
  std::vector<int> seen_from(static_cast<std::size_t>(by_low.groups()), Grouped::none);
  for (int node = 0; node < by_low.groups(); ++node) {
    for (const int e : by_low[node]) {
      int& seen = seen_from[static_cast<std::size_t>(high_of(e))];
      if (seen == node) return true;
      seen = node;
    }
  }
  return false;
}

}  // namespace qddot
