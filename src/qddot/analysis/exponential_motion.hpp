#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// The exact motion over one duration h of a system with constant K and C, also where its modes do
// not stay apart. From (q0, v0), with z = q - q0 and f = f(q0) without friction,
//   (z, z')' = A (z, z') + B M^-1 f,   A = [[0, I], [M^-1 K, -M^-1 C]],   B = [[0], [I]]
//   (z, z')(h) = e^(A h) B v0 + int_0^h e^(A s) ds B M^-1 f
// The exponential of the 3n x 3n matrix [[A, B], [0, 0]] h has e^(A h) and its integral, by scaling
// and squaring (Higham, SIAM J. Matrix Analysis 26 (2005) 1179-1193). It takes O(n^3) time once.
class ExponentialMotion {
 public:
  // Throws std::invalid_argument unless K and C are constant and every mass is positive.
  ExponentialMotion(const System& system, double duration);

  double duration() const { return duration_; }
  // Writes q and v of the state a duration after `from` into `to`.
  void propagate(const State& from, State& to) const;

 private:
  const System& system_;
  double duration_;
  Eigen::MatrixXd of_v_, of_push_;  // 2n x n: what v0 and M^-1 f add to (z, z')
};

}  // namespace qddot
