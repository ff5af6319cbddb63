#pragma once

#include <span>
#include <vector>

#include "qddot/algebra/multifrontal/front_kernels.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"
#include "qddot/model/system.hpp"

namespace qddot::multifrontal {

// The dense matrix of one supernode: `pivots` columns that become columns of L, and the `below` x
// `below` update of the rest. Rows and columns are numbered pivots first. The rows below begin at
// the next whole strip; the numbers between are zero.
struct Front {
  int first, pivots, below;
  Index factor, update;  // the starts of its part of L and of its update, in doubles
  bool kept;             // the update is for a front above the branches
  int row_start, row_end;
  int entry_start, entry_end;
  int run_start, run_end;
  int child_start, child_end;

  int pivot_strips() const { return strips_of(pivots); }
  int below_strips() const { return strips_of(below); }
  int strips() const { return pivot_strips() + below_strips(); }
  // Rows of the whole, of the pivots and of the update, filled up to whole strips.
  int height() const { return strip_height * strips(); }
  int pivot_height() const { return strip_height * pivot_strips(); }
  int below_height() const { return strip_height * below_strips(); }
};

// Fronts [start, end): subtrees that need no other fronts. A branch is small beside the whole, so
// that one thread can do it. The tree is divided in the same way for any number of threads.
struct Branch {
  int start, end;
};

// All fronts of a matrix a D - s K and every index that its factorisation needs.
class Fronts {
 public:
  Fronts(const SymmetricMatrix& pattern, SymbolicFactorization symbolic);

  // All fronts in the order of elimination: children before their parent.
  const std::vector<Front>& all() const { return all_; }
  const Front* begin() const { return all_.data(); }
  const Front* end() const { return all_.data() + all_.size(); }
  const std::vector<Branch>& branches() const { return branches_; }
  // Those above the branches, in the order of elimination: few, but the largest.
  const std::vector<int>& top() const { return top_; }
  // place()[i]: the position of unknown i in the order of elimination.
  const std::vector<int>& place() const { return place_; }

  std::span<const int> rows(const Front& f) const { return part(rows_, f.row_start, f.row_end); }
  // The front's entries of K, by strips of columns.
  std::span<const Entry> entries(const Front& f) const {
    return part(entries_, f.entry_start, f.entry_end);
  }
  // The rows of the front's update as rows of its parent.
  std::span<const Run> runs(const Front& f) const { return part(runs_, f.run_start, f.run_end); }
  std::span<const int> children(const Front& f) const {
    return part(children_, f.child_start, f.child_end);
  }

  // The memory of fronts that are eliminated one after the other: doubles of the updates that exist
  // at once, doubles of the largest columns of pivots, rows of the highest front.
  struct Sizes {
    Index updates = 0, pivot_columns = 0;
    int height = 0;
  };
  // The sizes of any branch, without kept updates, and of the fronts above, with them.
  Sizes branch_sizes, top_sizes;
  Index factor_size = 0;  // doubles of L

 private:
  template <class T>
  static std::span<const T> part(const std::vector<T>& all, int start, int end) {
    return std::span(all).subspan(start, end - start);
  }
  // Neighbours among the entries of K, in the order of elimination.
  struct Placed {
    int source, column, row;
    short length;
    bool across;
  };
  std::vector<Placed> in_order_of_elimination(const SymmetricMatrix& pattern) const;
  // `position`: of its parent's rows.
  void add_runs(Front& child, const std::vector<int>& position);
  void divide(const std::vector<int>& parents);
  void place_updates(const std::vector<int>& parents);

  std::vector<Front> all_;
  std::vector<Branch> branches_;
  std::vector<int> top_, place_, rows_, children_;
  std::vector<Entry> entries_;
  std::vector<Run> runs_;
};

}  // namespace qddot::multifrontal
