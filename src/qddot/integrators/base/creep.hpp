#pragma once

#include <cstdint>

namespace qddot {

// Detects an adaptive run that creeps towards a time and does not pass it: the mean of a thousand
// successive steps is below 1e-12 of the time left.
class Creep {
 public:
  explicit Creep(double t = 0) : t_mark_(t) {}

  // To be called after each step, which ended at t [s].
  bool is_found(double t, double t_end) {
    if (++steps_ % steps_in_a_row != 0) return false;
    const bool result = t - t_mark_ < steps_in_a_row * smallest_mean_step * (t_end - t_mark_);
    t_mark_ = t;
    return result;
  }

 private:
  static constexpr int steps_in_a_row = 1000;
  static constexpr double smallest_mean_step = 1e-12;

  std::int64_t steps_ = 0;
  double t_mark_;  // start of the present thousand steps
};

}  // namespace qddot
