#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// The exact motion of a system whose K is constant, mode by mode. From (q0, v0), with
// z = M^1/2 (q - q0),
//   z'' = -A z + b,  A = -M^-1/2 K M^-1/2 = U diag(w^2) U',  b = M^-1/2 f(q0),
// and in each mode y = U'z, y(0) = 0:
//   y(t) = y'(0) sin(wt)/w + b (1 - cos wt)/w^2,
// which for w = 0 is y'(0) t + b t^2/2. No step, so no step error: what is left is the rounding of
// the dense eigenproblem (O(n^3) time, once, and n^2 memory; a motion is O(n^2)). The system must
// outlive it.
class LinearMotion {
 public:
  // Throws std::invalid_argument unless K is constant and every mass is positive.
  explicit LinearMotion(const System& system);

  // What a motion needs room for besides its end.
  struct Scratch {
    Vec f, velocity, push, y, rate;
  };

  // The state a time `duration` [s] after `from`.
  State after(const State& from, double duration) const;
  // The same into `to`, another state, without allocation where both have been used before.
  void propagate(const State& from, double duration, State& to, Scratch& scratch) const;

 private:
  const System& system_;
  Vec root_mass_;      // M^1/2
  Eigen::MatrixXd u_;  // modes, a column each
  Vec omega_;          // [rad/s]
};

}  // namespace qddot
