#pragma once

#include <cstdint>

#include "qddot/algebra/solver.hpp"

namespace qddot {

struct Method;

// The options of a run: the method's knob, and the others that it takes (Method::takes).
struct Options {
  double step_size = 0;              // h [s], for fixed-step methods
  double rtol = 0;                   // relative tolerance, for adaptive methods
  double atol = 0;                   // absolute, [m] for q and [m/s] for v; 0: rtol times these:
  double length = 1;                 // [m], a typical size of positions
  double speed = 1;                  // [m/s], a typical size of velocities
  int max_order = 0;                 // for methods of variable order; 0: their own
  bool stability_detection = false;  // CVODE's: lowers the order if BDF is not stable
  int iterations = 0;                // a step, for methods with a given number; 0: their own
  bool timed = false;                // whether to fill Summary::seconds
  // The part of a stage's prediction error that a nonlinear solve may leave, in hand-written
  // implicit methods; 0: the method's own choice. That error is of the size of the step's own.
  double solve_tolerance = 0;
  // The factor by which a step of a generalised-alpha method multiplies a vibration of infinite
  // frequency, from 0 (gone at once) to 1 (undamped).
  double spectral_radius = 0.8;
  Solver solver = Solver::automatic;  // for methods that solve with M - s K
  // Whether a splitting keeps the rounding error of each addition to q and v, and adds it to the
  // next (see compensated_sum.hpp).
  bool compensated = false;
  // The number of force evaluations after which a run ends, over budget; 0: none. Each part of a
  // system of blocks has this number for itself.
  std::int64_t most_forces = 0;
};

// The options that a method may take (Method::takes), beside its knob and scales.
enum class Option {
  max_order,  // `order` is then the highest possible
  stability_detection,
  iterations,
  solve_tolerance,
  spectral_radius,
  solver,
  compensated,
};

// The smallest rtol: the sum of several roundings in a step's error hides smaller ones.
constexpr double least_rtol = 1e-15;

// Throws std::invalid_argument unless the method can run with these: step size, sizes and
// tolerances above 0, shares from 0 to 1. The message names the option, its value and the allowed
// ones.
void check_options(const Method& method, const Options& options);

}  // namespace qddot
