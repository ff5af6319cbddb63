#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "src/model/system.hpp"

namespace qddot {

// Where the coordinates of D-dimensional nodes stand among the unknowns: coordinate axis(i, a) of
// node i, a = 0 ... count(i) - 1, is unknown first(i) + a. Two kinds of one interface, so that the
// common one costs nothing.

// All coordinates of all nodes are unknowns.
template <int D>
class FullLayout {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  explicit FullLayout(Index nodes) : nodes_(nodes) {}

  Index nodes() const { return nodes_; }
  static Index first(int i) { return Index(D) * i; }
  static constexpr int count(int) { return D; }
  static constexpr int axis(int, int a) { return a; }
  static Point at(const Vec& q, int i) { return q.segment<D>(first(i)); }
  static void add(const Point& x, int i, Vec& f) { f.segment<D>(first(i)) += x; }
  static void subtract(const Point& x, int i, Vec& f) { f.segment<D>(first(i)) -= x; }

 private:
  Index nodes_;
};

// Some coordinates stay zero and are no unknowns.
template <int D>
class PartialLayout {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  // `zero`: for each node, a bit for each coordinate that is none.
  explicit PartialLayout(const std::vector<unsigned>& zero) : axes_(zero.size()) {
    for (std::size_t i = 0; i < zero.size(); ++i) {
      for (int d = 0; d < D; ++d) {
        if (!(zero[i] >> d & 1)) axes_[i][count_in(axes_[i])++] = d;
      }
      first_.push_back(first_.back() + count_in(axes_[i]));
    }
  }

  Index nodes() const { return std::ssize(axes_); }
  Index first(int i) const { return first_[i]; }
  int count(int i) const { return axes_[i][D]; }
  int axis(int i, int a) const { return axes_[i][a]; }
  Point at(const Vec& q, int i) const {
    Point x = Point::Zero();
    for (int a = 0; a < count(i); ++a) x[axis(i, a)] = q[first(i) + a];
    return x;
  }
  void add(const Point& x, int i, Vec& f) const {
    for (int a = 0; a < count(i); ++a) f[first(i) + a] += x[axis(i, a)];
  }
  void subtract(const Point& x, int i, Vec& f) const { add(-x, i, f); }

 private:
  using Axes = std::array<int, D + 1>;  // the coordinates, and last their count
  static int& count_in(Axes& axes) { return axes[D]; }

  std::vector<Axes> axes_;
  std::vector<Index> first_{0};
};

}  // namespace qddot
