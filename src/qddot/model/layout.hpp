#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "qddot/model/system.hpp"

namespace qddot {

// Maps the coordinates of D-dimensional nodes to unknowns. Coordinates that stay zero are no
// unknowns. Coordinate axis(i, a) of node i, a = 0 ... count(i) - 1, is unknown first(i) + a.
template <int D>
class Layout {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  // `zero`: bit d of a node is set if its coordinate d stays zero; empty if none does.
  Layout(Index nodes, const std::vector<unsigned>& zero) : axes_(static_cast<std::size_t>(nodes)) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      int count = 0;
      for (int d = 0; d < D; ++d) {
        if (zero.empty() || !(zero[i] >> d & 1)) axes_[i][count++] = d;
      }
      axes_[i][D] = count;
      first_.push_back(first_.back() + count);
    }
  }

  Index nodes() const { return std::ssize(axes_); }
  int first(int i) const { return first_[i]; }
  int count(int i) const { return axes_[i][D]; }
  int axis(int i, int a) const { return axes_[i][a]; }
  // Whether all coordinates of node i are unknowns.
  bool is_full(int i) const { return count(i) == D; }

  // The D coordinates of node i in q, and the addition of x to those of node i in f.
  Point at(const VecView& q, int i) const {
    Point x = Point::Zero();
    for (int a = 0; a < count(i); ++a) x[axis(i, a)] = q[first(i) + a];
    return x;
  }
  void add(const Point& x, int i, MutableVec f) const {
    for (int a = 0; a < count(i); ++a) f[first(i) + a] += x[axis(i, a)];
  }

 private:
  std::vector<std::array<int, D + 1>> axes_;  // the coordinates, then their count
  std::vector<int> first_{0};
};

}  // namespace qddot
