#pragma once

#include <cmath>

#include <Eigen/Core>

namespace qddot::reduce {

// The displacement D(t) of a mass that feels a constant acceleration a and the air, in closed form:
//   D'' = a - alpha D',   D(0) = 0,   D'(0) = v0
//   D' = v0 + s (a - alpha v0),   D = t v0 + r (a - alpha v0)
//   s = (1 - e^(-alpha t))/alpha,   r = (t - s)/alpha
// Without air s = t and r = t^2/2. In air the speed tends to a/alpha.
struct Flight {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // v0 [m/s]
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();   // a [m/s^2]
  double air_damping = 0;                              // alpha [1/s]

  bool moves() const { return !velocity.isZero(0) || !gravity.isZero(0); }
  Eigen::Vector3d displacement(double t) const {
    if (air_damping == 0) return t * velocity + (0.5 * t * t) * gravity;
    return t * velocity + twice_decayed(t) * slowed();
  }
  Eigen::Vector3d velocity_at(double t) const {
    if (air_damping == 0) return velocity + t * gravity;
    return velocity + decayed(t) * slowed();
  }
  // The energy that the air has taken [J/kg]: that of a's work and of the start which is no longer
  // in the motion.
  double dissipated(double t) const {
    if (air_damping == 0) return 0;
    const Eigen::Vector3d now = velocity_at(t);
    return 0.5 * (velocity - now).dot(velocity + now) + gravity.dot(displacement(t));
  }

 private:
  Eigen::Vector3d slowed() const { return gravity - air_damping * velocity; }
  // s
  double decayed(double t) const { return -std::expm1(-air_damping * t) / air_damping; }
  // r, for small alpha t by t^2 (1/2! - x/3! + x^2/4! - ...), x = alpha t
  double twice_decayed(double t) const {
    constexpr double small = 0.1;  // above it the difference loses a digit
    const double x = air_damping * t;
    if (x > small) return (t - decayed(t)) / air_damping;
    double term = 0.5, sum = 0;
    for (int n = 3; n < 16; ++n) {
      sum += term;
      term *= -x / n;
    }
    return t * t * sum;
  }
};

}  // namespace qddot::reduce
