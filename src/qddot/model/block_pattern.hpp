#pragma once

#include <algorithm>
#include <vector>

#include "qddot/model/layout.hpp"

namespace qddot {

// The lower triangle of a network's K, and the place of each block in it. The column of node j's
// coordinate a holds the rows a, a + 1, ... of its own block, then the rows of each neighbour i > j
// in ascending order. A block's place follows from its node's first column and its place below the
// diagonal block, so assembly searches nothing.
template <int D>
class BlockPattern {
 public:
  explicit BlockPattern(const Layout<D>& layout) : layout_(layout), below_(layout.nodes()) {}

  // Says that K has a block for nodes i and j; i = j has one anyway.
  void join(int i, int j) {
    if (i != j) below_[std::min(i, j)].push_back({std::max(i, j), 0});
  }

  // The pattern with zero values. Call once, after all joins.
  SymmetricMatrix make() {
    const Index n = layout_.first(static_cast<int>(layout_.nodes()));
    Index nonzeros = 0;
    for (int node = 0; node < layout_.nodes(); ++node) {
      auto& list = below_[node];
      std::ranges::sort(list, {}, &Neighbour::node);
      const auto same = [](const Neighbour& a, const Neighbour& b) { return a.node == b.node; };
      list.erase(std::unique(list.begin(), list.end(), same), list.end());
      int rows = 0;
      for (Neighbour& neighbour : list) {
        neighbour.rows_before = rows;
        rows += layout_.count(neighbour.node);
      }
      const int count = layout_.count(node);
      nonzeros += count * (count + 1) / 2 + count * rows;
    }
    SymmetricMatrix pattern(n, n);
    pattern.reserve(nonzeros);
    for (int node = 0; node < layout_.nodes(); ++node) {
      const int end = layout_.first(node + 1);
      for (int column = layout_.first(node); column < end; ++column) {
        pattern.startVec(column);
        for (int row = column; row < end; ++row) pattern.insertBack(row, column) = 0;
        for (const Neighbour& neighbour : below_[node]) {
          const int last = layout_.first(neighbour.node + 1);
          for (int row = layout_.first(neighbour.node); row < last; ++row) {
            pattern.insertBack(row, column) = 0;
          }
        }
      }
    }
    pattern.finalize();
    return pattern;
  }

  // The number of rows between node min(i, j)'s own block and the block of i and j, which must be
  // joined. Valid after make().
  int place(int i, int j) const {
    if (i == j) return 0;
    const auto& list = below_[std::min(i, j)];
    return std::ranges::lower_bound(list, std::max(i, j), {}, &Neighbour::node)->rows_before;
  }

 private:
  struct Neighbour {
    int node, rows_before;
  };

  const Layout<D>& layout_;
  std::vector<std::vector<Neighbour>> below_;  // the neighbours i > j of each node j
};

}  // namespace qddot
