#pragma once

#include "qddot/algebra/solver.hpp"

namespace qddot {

struct Method;

// What a method is told before it runs: its knob, and what it listens to (Method::takes).
struct Options {
  double step_size = 0;  // h [s], of fixed-step methods
  double rtol = 0;       // relative tolerance of adaptive ones,
  double atol = 0;       // and the absolute one, in m for q and m/s for v; 0: rtol times these:
  double length = 1;     // [m], what a position is large or small by
  double speed = 1;      // [m/s], likewise a velocity
  int max_order = 0;     // of methods of variable order; 0: their own
  bool stability_detection = false;  // CVODE's, which lowers the order where BDF is not stable
  int iterations = 0;  // a step, of methods that take as many as they are told; 0: their own
  bool timed = false;  // whether to fill Summary::seconds
  // The part of the error of a stage's prediction that a nonlinear solve may leave, in hand-written
  // implicit methods; 0: the method's own choice. That error is of the size of the step's own.
  double solve_tolerance = 0;
  // The factor by which a step of a generalised-alpha method multiplies a vibration of infinite
  // frequency, from 0 (gone at once) to 1 (undamped).
  double spectral_radius = 0.8;
  Solver solver = Solver::automatic;  // of methods that solve with M - s K
  // Whether a splitting keeps what rounding takes from q and v at each addition, and adds it with
  // the next (see compensated_sum.hpp).
  bool compensated = false;
};

// A step's error adds up several roundings of 2.2e-16, from which no smaller one can be told.
constexpr double least_rtol = 1e-15;

// Throws std::invalid_argument, naming the option, its value and what is allowed, unless the method
// can be run with these: a step size, sizes and tolerances above 0, shares from 0 to 1.
void check_options(const Method& method, const Options& options);

}  // namespace qddot
