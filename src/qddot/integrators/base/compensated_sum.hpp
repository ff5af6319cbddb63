#pragma once

#include "qddot/model/vector_updates.hpp"

namespace qddot {

// A running sum x of increments that keeps the rounding error of each addition in a rest r:
//   d = r + increment,   x' = x + d,   r' = d + (x - x').
// The error of x + r comes from the rounding of increments, not of the sum (Kahan, Comm. ACM 8
// (1965) 40; Hairer, Lubich and Wanner, Geometric Numerical Integration, VIII.5). If it is off, it
// is the plain sum, at its cost. It relies on the order of operations, which no compiler option
// here changes.
class CompensatedSum {
 public:
  CompensatedSum(bool is_on, Index n) : rest_(is_on ? n : 0) { restart(); }

  // Begins a new sum.
  void restart() { rest_.setZero(); }

  // x' = x + c z; `next` is sized n, and may be `now`.
  void add_scaled(const Vec& now, double c, const Vec& z, Vec& next) {
    if (rest_.size() == 0) return qddot::add_scaled(now, c, z, next);
    add(now, c * z, next);
  }
  // x' = x + c f/m
  void add_quotient(const Vec& now, double c, const Vec& f, const Mass& m, Vec& next) {
    if (rest_.size() == 0) return qddot::add_quotient(now, c, f, m, next);
    add(now, c * f.cwiseQuotient(m), next);
  }

 private:
  template <class Increment>
  void add(const Vec& now, const Eigen::MatrixBase<Increment>& increment, Vec& next) {
    for (Index i = 0; i < rest_.size(); ++i) {
      const double before = now[i], more = rest_[i] + increment.coeff(i), after = before + more;
      rest_[i] = more + (before - after);
      next[i] = after;
    }
  }

  Vec rest_;  // empty if it is off
};

}  // namespace qddot
