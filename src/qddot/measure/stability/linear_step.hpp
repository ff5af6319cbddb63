#pragma once

#include <complex>
#include <vector>

#include "qddot/integrators/method.hpp"

namespace qddot::inline measure {

// The effect of one fixed step of h w = `h_omega` on a vibration q'' = -w^2 q. A step multiplies (w
// q, v), and all that the method remembers of earlier steps, by a matrix. The roots are the
// matrix's eigenvalues, which decide the long run. The exact motion has the one pair exp(+- i h w).
// With damping, q'' = -w^2 q - 2 zeta w q', it is exp((-zeta +- i sqrt(1 - zeta^2)) h w).
struct LinearStep {
  double h_omega = 0;
  std::vector<std::complex<double>> roots{};  // the largest modulus first
  double zeta = 0;                            // of the exact motion

  // The largest modulus: above 1 the vibration grows, below 1 it dies.
  double spectral_radius() const { return std::abs(roots.front()); }
  // The root that is to be the exact motion's: the first one and, with damping, that next to its
  // root if nothing grows. Other roots of a method with memory may die later than the motion does.
  std::complex<double> principal() const;
  // The damping ratio zeta of a damped oscillator with the same principal roots exp((-zeta +- i
  // sqrt(1 - zeta^2)) w' h), where w' is the method's frequency for w (Hughes, The Finite Element
  // Method, section 9.3). 1 if the method no longer vibrates; negative if it grows.
  double damping_ratio() const;
  // The period of the damped vibration over the true one, minus 1; infinite if it does not vibrate.
  double period_error() const;
};

// Whether a step of the method multiplies an oscillator's state by one matrix. Its steps must be
// fixed and not only for a part of the forces.
inline bool has_linear_step(const Method& method) {
  return method.knob == Knob::step_size && !method.asks(Need::split_forces) &&
         !method.asks(Need::constraints);
}

// The responses Y_0 = I, Y_1, Y_2, ... after each step: 2 x 2 matrices whose columns are the states
// from the two starts (1, 0) and (0, 1), or these in other units.
using Responses = std::vector<Eigen::Matrix2d>;
constexpr int steps_observed = 7;

// The roots of the smallest linear recurrence that gives Y_0 ... Y_7. It is Y_n = (Y_1 Y_0^-1)^n
// Y_0 for a method without memory, else Y_n = C A^n B. A follows from the matrices of Y_(i+j) and
// Y_(i+j+1) (Ho and Kalman, Regelungstechnik 14 (1966) 545-548), with a row for each number that
// the method remembers. `noise`: relative error of the responses to a start, and of A.
// k equal roots move by its k-th root. Rows and columns of Y may have any units, in which their
// rounding is some 1e-16. If there are fewer responses, steps have overflowed. Then Y_1 alone
// decides; without Y_1, or with memory, the one root is infinite.
std::vector<std::complex<double>> roots_of(const Responses& y, double noise);

// The method's step at that h w: given by the method itself (Method::recurrence_roots), or found by
// running it with `options`, except for their step size. `zeta`: the damping ratio of the
// vibration. Throws std::runtime_error with the reason if a step fails. Throws
// std::invalid_argument for a method without fixed steps, and for damping that the method refuses.
LinearStep linear_step(const Method& method, double h_omega, Options options = {}, double zeta = 0);

}  // namespace qddot::inline measure
