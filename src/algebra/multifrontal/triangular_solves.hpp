#pragma once

#include "qddot/algebra/factors.hpp"
#include "qddot/algebra/large_array.hpp"
#include "qddot/algebra/multifrontal/fronts.hpp"

namespace qddot::multifrontal {

// Solves P' L E L' P x = b with the factors of fronts. L is read twice and nothing else is large,
// so that a solve takes as long as reading does.
class TriangularSolves {
 public:
  // l: factor_size doubles, each front's strip after strip of its pivots' columns (see strips.hpp);
  // pivots: E, in the order of elimination. Both and the fronts must outlive this.
  TriangularSolves(const Fronts& fronts, const double* l, const double* pivots);

  // b, x: n.
  void solve(const Vec& b, Vec& x);
  // The same for four right-hand sides at once.
  void solve(const FourColumns& b, FourColumns& x);

 private:
  // Of L z = b: the front's pivots of z, and what they take off the rows below.
  void forward(const Front& f);
  // Of L' x = y: the front's pivots of x.
  void backward(const Front& f);
  // Both for four right-hand sides; backwards() divides by the pivots, too.
  void forwards(const Front& f);
  void backwards(const Front& f);

  // L of the front: strip i from column k on.
  const double* factor(const Front& f, int i, int k) const {
    return l_ + f.factor + (Index{i} * f.pivots + k) * 8;
  }

  const Fronts& fronts_;
  const double *l_, *pivot_;
  LargeArray y_, gathered_;
};

}  // namespace qddot::multifrontal
