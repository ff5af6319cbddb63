#pragma once

#include <optional>

#include "qddot/analysis/forced_modes.hpp"
#include "qddot/model/system.hpp"

namespace qddot {

// The exact motion of a system with constant K, mode by mode. The motion from (q0, v0) obeys, in
// z = M^1/2 (q - q0),
//   z'' = -A z + b,  A = -M^-1/2 K M^-1/2 = U diag(w^2) U',  b = M^-1/2 f(q0),
// and each mode y = U'z, with y(0) = 0, is
//   y(t) = y'(0) sin(wt)/w + b (1 - cos wt)/w^2,
// or y'(0) t + b t^2/2 if w = 0. Where V falls along a mode, w^2 = -s^2 is negative and
//   y(t) = y'(0) sinh(st)/s + b (cosh st - 1)/s^2.
// Modes stay apart with C = alpha M - beta K, as of air and of dashpots in proportion to stiffness.
// Each is then damped by gamma = (alpha + beta w^2)/2 (see damped_mode.hpp).
// Forces of time push modes beside (see forced_modes.hpp), from corner to corner.
// There is no step and no step error, only the rounding of the dense eigenproblem. That takes
// O(n^3) time once and n^2 memory; a motion is O(n^2). The system must outlive it.
class LinearMotion {
 public:
  // Throws std::invalid_argument unless K is constant and every mass is positive. So it does if the
  // system has another Damping, or its forces are other functions of time than Forcing.
  explicit LinearMotion(const System& system);

  // The workspace of a motion.
  struct Scratch {
    Vec f, velocity, push, y, rate;
    std::optional<ForcedModes> forced{};
  };

  // The state `duration` [s] after `from`.
  State after(const State& from, double duration) const;
  // The same into `to`, another state; allocates nothing if both have been used before.
  void propagate(const State& from, double duration, State& to, Scratch& scratch) const;

  // The modes U, one in each column, and w^2 [rad^2/s^2], ascending.
  const Eigen::MatrixXd& modes() const { return u_; }
  const Vec& squares() const { return squares_; }
  // The largest frequency, or rate of growth, of a mode [rad/s].
  double fastest() const;

  // Whether modes stay apart: there is no damping, or one of that kind, and forces of time are
  // known.
  static bool has_modes(const System& system);

 private:
  const System& system_;
  Vec root_mass_;      // M^1/2
  Eigen::MatrixXd u_;  // modes, one in each column
  Vec squares_;        // w^2 [rad^2/s^2]
  Vec gamma_;          // [1/s]; empty without damping
};

}  // namespace qddot
