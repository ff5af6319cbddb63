#pragma once

#include <chrono>
#include <cstdint>
#include <limits>

namespace qddot {

// The work of a run. `steps` counts accepted steps, `solves` counts right-hand sides.
struct Counts {
  std::int64_t steps = 0, rejected = 0, force_evaluations = 0, stiffness_evaluations = 0,
               factorizations = 0, solves = 0, newton_iterations = 0;
  std::int64_t indefinite_factorizations = 0;  // of indefinite matrices, in SUNDIALS' methods
  // The sum of the orders of all steps, and how often it was lowered; for methods of variable
  // order.
  std::int64_t order_sum = 0, order_reductions = 0;
  std::int64_t stability_limited_steps = 0;  // held to 1/w_max by adaptive explicit methods

  bool operator==(const Counts&) const = default;
  Counts& operator+=(const Counts& more);
};

// The time of a run by kinds of work [s]; zero unless Options::timed.
struct Seconds {
  double force = 0, stiffness = 0, factorization = 0, solve = 0;

  Seconds& operator+=(const Seconds& more);
};

// Adds the time [s] from its construction to its destruction to one member of Seconds.
class Stopwatch {
 public:
  Stopwatch(Seconds* seconds, double Seconds::*which) : seconds_(seconds), which_(which) {
    if (seconds_) start_ = std::chrono::steady_clock::now();
  }
  ~Stopwatch() {
    using seconds = std::chrono::duration<double>;
    if (seconds_) seconds_->*which_ += seconds(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Seconds* seconds_;  // may be nullptr
  double Seconds::*which_;
  std::chrono::steady_clock::time_point start_;
};

// The mean order of the steps; NaN for a method of fixed order.
inline double order_mean(const Counts& counts) {
  return counts.order_sum > 0
             ? static_cast<double>(counts.order_sum) / static_cast<double>(counts.steps)
             : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace qddot
