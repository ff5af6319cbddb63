#pragma once

#include <vector>

#include "qddot/integrators/base/adaptive_step.hpp"
#include "qddot/integrators/base/nystrom_stages.hpp"
#include "qddot/integrators/base/renewed_bound.hpp"

namespace qddot {

// Steps of an embedded pair; the higher order is propagated. Each attempt takes s - 1 forces; an
// accepted one takes another at its end unless that is its last stage. The error test does not see
// an instability of modes that hardly move yet. So steps are held to h <= stable_hw/w_max, with
// Gershgorin's bound of w_max, renewed every few steps. Without K there is no bound, and the error
// test is the only limit.
class Nystrom final : public AdaptiveStep {
 public:
  Nystrom(SystemRun& run, const NystromPair& pair, std::size_t instants);

 private:
  void start(const State& state) override;
  double longest_step(const Instant& now) override;
  Outcome attempt(const Instant& now, double h, Instant& next, Vec& error_q, Vec& error_v) override;

  const NystromPair& pair_;
  std::vector<double> error_b_, error_b_prime_;
  bool is_first_same_as_last_;
  NystromStages stages_;
  RenewedBound w_max_;
};

}  // namespace qddot
