#pragma once

#include <memory>
#include <vector>

#include "qddot/model/capabilities.hpp"

namespace qddot {

class Factors;

// The forces -G'lambda that keep the constraints of a system, by the symmetric matrix
//   A = G M^-1 G'   (m x m)
// A is positive definite if G has independent rows. Its pattern is analysed once. Of a chain of
// rods it is tridiagonal.
class Multipliers {
 public:
  // Borrows the system, which may have no constraints: then m = 0. Its masses are above 0 where
  // constraints act.
  explicit Multipliers(const System& system);
  ~Multipliers();
  Multipliers(const Multipliers&) = delete;
  Multipliers& operator=(const Multipliers&) = delete;

  Index count() const { return gradients_.rows(); }
  // G where take_gradients() was called last.
  const GradientMatrix& gradients() const { return gradients_; }
  // Computes G at a place.
  void take_gradients(const At& at);
  // Factorises A of the present G, or A + s diag(c) with the compliances c. Returns false if it is
  // not positive definite.
  bool factorize(double s = 0);
  // x = A^-1 b, by the last factors; b, x: m.
  void solve(const Vec& b, Vec& x);
  // Adds s M^-1 G'x to `v`, by the present G; x: m, v: n.
  void add_pull(double s, const Vec& x, Vec& v) const;
  // The multipliers [N], m, of a place with velocities, at which A is factorised; f: all other
  // forces there. They make G q'' what keeps the constraints:
  //   A lambda = G M^-1 f + g'' at q'' = 0
  const Vec& forces_at(const At& at, const ConstVec& f);
  // Changes `v` by -M^-1 G'x such that G v + dg/dt = 0, and returns x; A is factorised at `at`.
  const Vec& project_velocities(const At& at, Vec& v);
  // Moves q to g = 0 up to rounding, along M^-1 G', and projects v there; both of a place that is
  // near. Returns false where that fails. `q` and `v` hold the numbers of `at`.
  bool project(At at, Vec& q, Vec& v);
  // The largest |g| [m] that is rounding at q: a few roundings of coordinates and lengths.
  double rounding(const VecView& q) const;

 private:
  // A summand of an entry of A: values a and b of G, and the unknown that both belong to.
  struct Term {
    int a, b, unknown;
  };

  const System& system_;
  const Constraints* constraints_;  // nullptr if it has none
  Vec per_mass_;                    // M^-1
  GradientMatrix gradients_;
  SymmetricMatrix matrix_;
  std::vector<int> first_term_;  // of each entry of A, and last the number of all terms
  std::vector<Term> terms_;
  std::unique_ptr<Factors> factors_;
  Vec right_, lambda_;
  double longest_ = 0;  // 1/d2g/dq2, a rod's length [m]
};

}  // namespace qddot
