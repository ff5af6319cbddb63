#pragma once

#include <cstdint>

#include "qddot/analysis/largest_frequency.hpp"

namespace qddot {

// Gershgorin's bound of the largest frequency w_max [rad/s] of a system along its motion. It is
// renewed every 50 steps only, because it changes much less than the positions. A system without K
// has the bound 0, which limits no step.
class RenewedBound {
 public:
  explicit RenewedBound(const System& system)
      : system_(system), has_k_(system.has_stiffness()), k_(system.stiffness_pattern()) {}

  void start() { renewed_at_ = never; }
  // The bound for step number `step`, 0, 1, ..., of a run; stiffness(k) computes K at the step's
  // start.
  template <class Stiffness>
  double at(std::int64_t step, const Stiffness& stiffness) {
    if (!has_k_) return 0;
    if (renewed_at_ == never || step >= renewed_at_ + steps_with_one) {
      stiffness(k_);
      w_max_ = frequency_bound(system_.mass(), k_, row_sums_);
      renewed_at_ = step;
    }
    return w_max_;
  }

 private:
  static constexpr std::int64_t steps_with_one = 50, never = -1;

  const System& system_;
  bool has_k_;
  SymmetricMatrix k_;
  Vec row_sums_;
  double w_max_ = 0;
  std::int64_t renewed_at_ = never;
};

}  // namespace qddot
