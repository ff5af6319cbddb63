#pragma once

#include <complex>
#include <vector>

#include "qddot/integrators/method.hpp"

namespace qddot::measure {

// What a method of fixed steps does to a vibration q'' = -w^2 q in a step of h w = `h_omega`:
// (w q, v) and whatever it remembers of earlier steps are multiplied by a matrix, and in the long
// run by the matrix' roots (eigenvalues). The exact motion has the one pair exp(+- i h w).
struct LinearStep {
  double h_omega = 0;
  std::vector<std::complex<double>> roots{};  // the largest modulus first

  // The largest modulus: above 1 the vibration grows, below 1 it dies.
  double spectral_radius() const { return std::abs(roots.front()); }
  // zeta, as a damped oscillator has it: roots are exp((-zeta +- i sqrt(1 - zeta^2)) w' h) with w'
  // the frequency that the method makes of w (Hughes, The Finite Element Method, section 9.3).
  // 1 where the method no longer vibrates; negative where it grows.
  double damping_ratio() const;
  // The period of the damped vibration over the true one, less 1; infinite where it does not
  // vibrate.
  double period_error() const;
};

// Whether the method steps an oscillator by a matrix of its own: its steps are fixed, and not for a
// part of the forces only.
inline bool has_linear_step(const Method& method) {
  return method.knob == Knob::step_size && !method.asks(Need::split_forces);
}

// The responses Y_0 = 1, Y_1, Y_2, ... after each step of the two starts (1, 0) and (0, 1), as the
// columns of 2 x 2 matrices.
using Responses = std::vector<Eigen::Matrix2d>;
constexpr int steps_observed = 5;

// The roots of the smallest linear recurrence that makes Y_0 ... Y_5: Y_n = Y_1^n for a method
// without memory; else Y_n = C A^n B, of which A follows from the matrices of Y_(i+j) and Y_(i+j+1)
// (Ho and Kalman, Regelungstechnik 14 (1966) 545-548) with as many rows as the method remembers
// numbers, up to 4. `noise`: how well the responses are known. Fewer responses are those of steps
// that overflow: then Y_1 alone decides, or, where there is none or memory, the one root is
// infinite.
std::vector<std::complex<double>> roots_of(const Responses& y, double noise);

// The method's own step at that h w: what it says itself (Method::recurrence_roots), or found by
// running it. Options but for the step size as given.
// Throws std::runtime_error, with the reason, where it does not make the steps, and
// std::invalid_argument for a method without fixed steps.
LinearStep linear_step(const Method& method, double h_omega, Options options = {});

}  // namespace qddot::measure
