#include "qddot/algebra/multifrontal/fronts.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace qddot::multifrontal {
namespace {

template <class T>
int append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return static_cast<int>(all.size());
}

}  // namespace

Fronts::Fronts(const SymmetricMatrix& pattern, SymbolicFactorization symbolic) {
  place_ = std::move(symbolic.place);
  const int n = static_cast<int>(pattern.rows());
  const int count = static_cast<int>(symbolic.supernodes.size());

  std::vector<int> parents(count);
  std::vector<std::vector<int>> children(count);
  for (int s = 0; s < count; ++s) {
    const Supernode& node = symbolic.supernodes[s];
    Front& f = all_.emplace_back();
    f.first = node.first;
    f.pivots = node.pivots;
    f.below = static_cast<int>(node.rows.size());
    f.row_start = static_cast<int>(rows_.size());
    f.row_end = append(rows_, node.rows);
    f.factor = factor_size;
    factor_size += Index{f.height()} * f.pivots;
    parents[s] = node.parent;
    if (node.parent >= 0) children[node.parent].push_back(s);
  }
  divide(parents);
  place_updates(parents);

  std::vector<int> position(n);  // of the present front's rows
  const std::vector<Placed> placed = in_order_of_elimination(pattern);
  auto entry = placed.begin();
  for (int s = 0; s < count; ++s) {
    Front& f = all_[s];
    for (int p = 0; p < f.pivots; ++p) position[f.first + p] = p;
    int next = f.pivot_height();
    for (const int row : rows(f)) position[row] = next++;

    f.entry_start = static_cast<int>(entries_.size());
    for (; entry != placed.end() && entry->column < f.first + f.pivots; ++entry) {
      const int target = position[entry->row] + (entry->column - f.first) * f.height();
      entries_.push_back({entry->source, target, entry->length, entry->across});
    }
    f.entry_end = static_cast<int>(entries_.size());
    f.child_start = static_cast<int>(children_.size());
    f.child_end = append(children_, children[s]);
    for (const int c : children[s]) add_runs(all_[c], position);
  }
}

// The entries of a matrix by columns, in the order of elimination: up to three together, such as
// those of a node. They do not leave the pivots of one front, nor its strip of columns, as threads
// divide strips among themselves.
std::vector<Fronts::Placed> Fronts::in_order_of_elimination(const SymmetricMatrix& pattern) const {
  constexpr short most = 3;
  std::vector<int> pivot(place_.size());  // among those of its front
  for (const Front& f : all_) std::iota(&pivot[f.first], &pivot[f.first] + f.pivots, 0);
  std::vector<Placed> placed;
  std::vector<int> start(pattern.cols() + 1);
  for (int j = 0; j < pattern.cols(); ++j) {
    const auto place = [&](int e) { return place_[pattern.innerIndexPtr()[e]]; };
    const int end = pattern.outerIndexPtr()[j + 1];
    for (int e = pattern.outerIndexPtr()[j]; e < end;) {
      const int source = e, first = place(e);
      const bool across = first < place_[j];
      short length = 1;
      const auto continues = [&](int next) {
        return length < most && next == first + length &&
               (across ? pivot[next] % strip_height : pivot[next]) != 0 &&
               across == (next < place_[j]);
      };
      while (++e < end && continues(place(e))) ++length;
      const auto [column, row] = std::minmax(first, place_[j]);
      placed.push_back({source, column, row, length, across});
      ++start[column + 1];
    }
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Placed> sorted(placed.size());
  for (const Placed& p : placed) sorted[start[p.column]++] = p;
  return sorted;
}

void Fronts::add_runs(Front& child, const std::vector<int>& position) {
  child.run_start = static_cast<int>(runs_.size());
  for (int i = 0; i < child.below; ++i) {
    const int to = position[rows_[child.row_start + i]];
    if (i > 0 && to == runs_.back().to + runs_.back().length) {
      ++runs_.back().length;
    } else {
      runs_.push_back({i, to, 1});
    }
  }
  child.run_end = static_cast<int>(runs_.size());
}

// Branches are the largest subtrees with at most a share of the work; smaller neighbours are
// joined. Shares are small enough for a few threads to divide them well. Work that takes no longer
// than a meeting of threads is not divided.
void Fronts::divide(const std::vector<int>& parents) {
  constexpr double shares = 16, least_work = 1e7;  // operations
  const int count = static_cast<int>(all_.size());
  std::vector<double> work(count);
  std::vector<int> start(count);  // the first front of each subtree
  for (int s = 0; s < count; ++s) start[s] = s;
  double whole = 0;
  for (int s = 0; s < count; ++s) {
    const Front& f = all_[s];
    const double height = f.height(), below = f.below_height();
    const double own = (height * height * height - below * below * below) / 3;
    work[s] += own;
    whole += own;
    if (parents[s] < 0) continue;
    work[parents[s]] += work[s];
    start[parents[s]] = std::min(start[parents[s]], start[s]);
  }
  const double share =
      whole < least_work ? std::numeric_limits<double>::infinity() : whole / shares;
  double last = share;  // the work of the last branch
  for (int s = 0; s < count; ++s) {
    if (work[s] > share) {
      top_.push_back(s);
      continue;
    }
    all_[s].kept = parents[s] >= 0 && work[parents[s]] > share;
    if (parents[s] >= 0 && !all_[s].kept) continue;
    const bool adjoins = !branches_.empty() && branches_.back().end == start[s];
    if (adjoins && last + work[s] <= share) {
      branches_.back().end = s + 1;
      last += work[s];
    } else {
      branches_.push_back({start[s], s + 1});
      last = work[s];
    }
  }
}

// Updates are created and consumed as on a stack, but a front's update begins to grow before those
// of its children are consumed. Two stacks, one for even and one for odd depths of the tree, leave
// each update in place. Updates that branches keep come first, as all of them exist at once. A
// strip's height is free before and after each update. Kernels read vectors at the ends of its
// columns whole, while another thread may write the next update.
void Fronts::place_updates(const std::vector<int>& parents) {
  const int count = static_cast<int>(all_.size());
  std::vector<int> depth(count);
  for (int s = count; s-- > 0;) {
    if (parents[s] >= 0) depth[s] = depth[parents[s]] + 1;
  }
  const auto size = [&](int s) {
    return Index{all_[s].below_height()} * all_[s].below_height() + strip_height;
  };
  using Stacks = std::array<Index, 2>;
  std::vector<int> first_child(count, -1);
  const auto stack = [&](int s, Stacks& top, Stacks& most) {
    Front& f = all_[s];
    const int own = depth[s] % 2;
    f.update = top[own];
    top[own] += size(s);
    most[own] = std::max(most[own], top[own]);
    if (first_child[s] >= 0) top[1 - own] = all_[first_child[s]].update;
    if (parents[s] >= 0 && first_child[parents[s]] < 0) first_child[parents[s]] = s;
  };
  const auto fit = [](Sizes& sizes, const Front& f) {
    sizes.pivot_columns = std::max(sizes.pivot_columns, Index{f.height()} * f.pivot_height());
    sizes.height = std::max(sizes.height, f.height());
  };
  Stacks most{};
  for (const Branch& branch : branches_) {
    Stacks top{};
    for (int s = branch.start; s < branch.end; ++s) {
      fit(branch_sizes, all_[s]);
      if (!all_[s].kept) {
        stack(s, top, most);
        continue;
      }
      all_[s].update = top_sizes.updates;
      top_sizes.updates += size(s);
      if (first_child[s] >= 0) top[1 - depth[s] % 2] = all_[first_child[s]].update;
    }
  }
  for (const Branch& branch : branches_) {
    for (int s = branch.start; s < branch.end; ++s) {
      if (!all_[s].kept && depth[s] % 2 == 1) all_[s].update += most[0];
    }
  }
  branch_sizes.updates = most[0] + most[1];

  Stacks top{}, most_of_top{};
  for (const int s : top_) {
    fit(top_sizes, all_[s]);
    stack(s, top, most_of_top);
  }
  for (const int s : top_) {
    all_[s].kept = true;
    all_[s].update += top_sizes.updates + (depth[s] % 2 == 1 ? most_of_top[0] : 0);
  }
  top_sizes.updates += most_of_top[0] + most_of_top[1];
}

}  // namespace qddot::multifrontal
