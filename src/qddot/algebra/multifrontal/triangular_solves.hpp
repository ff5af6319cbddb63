#pragma once

#include "qddot/algebra/factors.hpp"
#include "qddot/algebra/large_array.hpp"
#include "qddot/algebra/multifrontal/fronts.hpp"

namespace qddot::multifrontal {

// Solves P' L E L' P x = b with the factors of fronts. A solve takes as long as reading L twice;
// nothing else is large.
class TriangularSolves {
 public:
  // l: factor_size doubles, each front's strip after strip of its pivots' columns;
  // pivots: E, in the order of elimination. Both and the fronts must outlive this.
  TriangularSolves(const Fronts& fronts, const double* l, const double* pivots);

  // b, x: n.
  void solve(const Vec& b, Vec& x);
  // The same for four right-hand sides at once.
  void solve(const FourColumns& b, FourColumns& x);

 private:
  FrontFactor factor(const Front& f) const;

  const FrontKernels& kernels_ = front_kernels();
  const Fronts& fronts_;
  const double *l_, *pivot_;
  LargeArray y_, gathered_;
};

}  // namespace qddot::multifrontal
