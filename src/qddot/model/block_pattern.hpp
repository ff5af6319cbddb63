#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "qddot/model/grouped.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot {

// The lower triangle of a network's K, and the place of each block in it. The column of node j's
// coordinate a holds the rows a, a + 1, ... of its own block, then the rows of each neighbour i > j
// in ascending order. A block's place follows from its node's first column and its place below the
// diagonal block, so assembly searches nothing.
template <int D>
class BlockPattern {
 public:
  // K has a block for each node, and for the two nodes of each spring.
  BlockPattern(const Network& network, const Layout<D>& layout) : layout_(layout) {
    const auto links = static_cast<int>(network.links.size());
    const int images_end = links + static_cast<int>(network.image_links.size());
    const auto sorted = [](int i, int j) { return std::array{std::min(i, j), std::max(i, j)}; };
    const auto pair = [&](int k) {
      if (k < links) {
        const auto& link = network.links[static_cast<std::size_t>(k)];
        return sorted(link.i, link.j);
      }
      if (k < images_end) {
        const auto& link = network.image_links[static_cast<std::size_t>(k - links)];
        return sorted(link.i, link.j);
      }
      const auto& spring = network.general[static_cast<std::size_t>(k - images_end)];
      return sorted(spring.i, spring.j < 0 ? spring.i : spring.j);
    };
    const auto nodes = static_cast<int>(layout_.nodes());
    const int pairs = images_end + static_cast<int>(network.general.size());
    const Grouped by_low(nodes, pairs, [&](int k) {
      const auto [low, high] = pair(k);
      return low == high ? Grouped::none : low;
    });
    std::vector<int> highs;
    for (int node = 0; node < nodes; ++node) {
      begin_.push_back(below_.size());
      highs.clear();
      for (const int k : by_low[node]) highs.push_back(pair(k)[1]);
      std::ranges::sort(highs);
      highs.erase(std::unique(highs.begin(), highs.end()), highs.end());
      int rows = 0;
      for (const int high : highs) {
        below_.push_back({high, rows});
        rows += layout_.count(high);
      }
    }
    begin_.push_back(below_.size());
  }

  // The pattern with zero values.
  SymmetricMatrix make() const {
    const auto nodes = static_cast<int>(layout_.nodes());
    const Index n = layout_.first(nodes);
    Index nonzeros = 0;
    for (int node = 0; node < nodes; ++node) {
      const int count = layout_.count(node);
      nonzeros += count * (count + 1) / 2;
      for (const Neighbour& neighbour : below(node))
        nonzeros += count * layout_.count(neighbour.node);
    }
    SymmetricMatrix pattern(n, n);
    pattern.reserve(nonzeros);
    for (int node = 0; node < nodes; ++node) {
      const int end = layout_.first(node + 1);
      for (int column = layout_.first(node); column < end; ++column) {
        pattern.startVec(column);
        for (int row = column; row < end; ++row) pattern.insertBack(row, column) = 0;
        for (const Neighbour& neighbour : below(node)) {
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

  // The number of rows between node min(i, j)'s own block and the block of i and j, which must have
  // one.
  int place(int i, int j) const {
    if (i == j) return 0;
    return std::ranges::lower_bound(below(std::min(i, j)), std::max(i, j), {}, &Neighbour::node)
        ->rows_before;
  }

 private:
  struct Neighbour {
    int node, rows_before;
  };

  // The neighbours i > j of node j, ascending.
  std::span<const Neighbour> below(int node) const {
    const auto own = static_cast<std::size_t>(node);
    return std::span(below_).subspan(begin_[own], begin_[own + 1] - begin_[own]);
  }

  const Layout<D>& layout_;
  std::vector<std::size_t> begin_;  // of each node in below_, and the end
  std::vector<Neighbour> below_;
};

}  // namespace qddot
