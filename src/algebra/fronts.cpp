#include "src/algebra/fronts.hpp"

#include <algorithm>
#include <array>

namespace qddot {

namespace {

template <class T>
int append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return static_cast<int>(all.size());
}

}  // namespace

Fronts::Fronts(const SymmetricMatrix& pattern, Elimination elimination) {
  place_ = std::move(elimination.place);
  const int n = static_cast<int>(pattern.rows());
  const int count = static_cast<int>(elimination.supernodes.size());

  std::vector<int> front_of(n), parents(count);
  std::vector<std::vector<int>> children(count);
  for (int s = 0; s < count; ++s) {
    const Supernode& node = elimination.supernodes[s];
    Front& f = all_.emplace_back();
    f.first = node.first;
    f.pivots = node.pivots;
    f.below = static_cast<int>(node.rows.size());
    f.row_start = static_cast<int>(rows_.size());
    f.row_end = append(rows_, node.rows);
    f.factor = factor_size;
    factor_size += Index{f.height()} * f.pivots;
    pivot_columns_size = std::max(pivot_columns_size, Index{f.height()} * f.pivot_height());
    largest_height = std::max(largest_height, f.height());
    std::fill_n(front_of.begin() + f.first, f.pivots, s);
    parents[s] = node.parent;
    if (node.parent >= 0) children[node.parent].push_back(s);
  }
  place_updates(parents);

  std::vector<std::vector<Entry>> entries(count), diagonal(count);
  for (int j = 0; j < n; ++j) {
    for (int e = pattern.outerIndexPtr()[j]; e < pattern.outerIndexPtr()[j + 1]; ++e) {
      const int i = pattern.innerIndexPtr()[e];
      const auto [column, row] = std::minmax(place_[i], place_[j]);
      const Front& f = all_[front_of[column]];
      const int target = position(f, row) + (column - f.first) * f.height();
      entries[front_of[column]].push_back({e, target});
      if (i == j) diagonal[front_of[column]].push_back({j, target});
    }
  }
  for (int s = 0; s < count; ++s) {
    Front& f = all_[s];
    f.entry_start = static_cast<int>(entries_.size());
    f.entry_end = append(entries_, entries[s]);
    f.diagonal_start = static_cast<int>(diagonal_.size());
    f.diagonal_end = append(diagonal_, diagonal[s]);
    f.child_start = static_cast<int>(children_.size());
    f.child_end = append(children_, children[s]);
    f.run_start = static_cast<int>(runs_.size());
    for (int i = 0; i < f.below; ++i) {
      const Front& parent = all_[parents[s]];
      const int to = position(parent, rows_[f.row_start + i]);
      if (i > 0 && to == runs_.back().to + runs_.back().length) {
        ++runs_.back().length;
      } else {
        runs_.push_back({i, to, 1});
      }
    }
    f.run_end = static_cast<int>(runs_.size());
  }
}

int Fronts::position(const Front& f, int row) const {
  if (row < f.first + f.pivots) return row - f.first;
  const auto below = rows(f);
  return f.pivot_height() + static_cast<int>(std::ranges::lower_bound(below, row) - below.begin());
}

// Updates are made and used up as on a stack, but a front's own begins to grow before those of its
// children are used up. Two stacks in turn, one for even and one for odd depths of the tree, leave
// each update where it is made.
void Fronts::place_updates(const std::vector<int>& parents) {
  const int count = static_cast<int>(all_.size());
  std::vector<int> depth(count), first_child(count, -1);
  for (int s = count; s-- > 0;) {
    if (parents[s] < 0) continue;
    depth[s] = depth[parents[s]] + 1;
    first_child[parents[s]] = s;
  }
  std::array<Index, 2> top{}, most{};
  for (int s = 0; s < count; ++s) {
    const int stack = depth[s] % 2;
    all_[s].update = top[stack];
    top[stack] += Index{all_[s].below_height()} * all_[s].below_height();
    most[stack] = std::max(most[stack], top[stack]);
    if (first_child[s] >= 0) top[1 - stack] = all_[first_child[s]].update;
  }
  for (int s = 0; s < count; ++s) {
    if (depth[s] % 2 == 1) all_[s].update += most[0];
  }
  update_size = most[0] + most[1];
}

}  // namespace qddot
