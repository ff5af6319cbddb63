#pragma once

#include <vector>

#include "qddot/integrators/base/adaptive_step.hpp"
#include "qddot/integrators/base/renewed_bound.hpp"

namespace qddot {

// The coefficients of an embedded explicit Runge-Kutta-Nystrom pair for q'' = g(q) of s stages:
//   q_i = q_n + c_i h v_n + h^2 sum_{j<i} a_ij k_j,   k_i = g(q_i),
//   q_{n+1} = q_n + h v_n + h^2 sum_i b_i k_i,   v_{n+1} = v_n + h sum_i b'_i k_i
// (Hairer, Norsett and Wanner, Solving ODEs I, section II.14), and the same with the lower b and b'
// for the estimate of the errors.
struct NystromPair {
  int order = 0, lower_order = 0;
  // The largest h w up to which no vibration q'' = -w^2 q grows by more than a hundredth a step.
  double stable_hw = 0;
  std::vector<double> c{};
  std::vector<std::vector<double>> a{};  // row i holds i entries
  std::vector<double> b{}, b_prime{}, lower_b{}, lower_b_prime{};

  // Whether the last stage is the first one of the next step: q_s = q_{n+1}.
  bool is_first_same_as_last() const;
};

// Steps of a pair, whose higher order is propagated. Each attempt takes s - 1 forces, an accepted
// one another at its end unless that is its last stage. The error test does not see an instability
// of modes that hardly move yet, so steps are held to h <= stable_hw/w_max, with Gershgorin's bound
// of the largest frequency, taken anew every few steps. Where a system has no K, nothing bounds the
// frequency, and the error test has to do.
class Nystrom final : public AdaptiveStep {
 public:
  Nystrom(const Method& method, const System& system, const Options& options,
          const NystromPair& pair, std::size_t instants);

 private:
  void start(const State& state) override;
  double longest_step(const Instant& now) override;
  Outcome attempt(const Instant& now, double h, Instant& next, Vec& error_q, Vec& error_v) override;
  void accepted(Instant& next) override;

  const NystromPair& pair_;
  std::vector<double> error_b_, error_b_prime_;
  bool is_first_same_as_last_;
  Eigen::MatrixXd k_;  // n x s, the stages' accelerations
  Vec stage_;
  RenewedBound w_max_;
};

// The pairs of Dormand, El-Mikkawy and Prince, each in the file of its method.
namespace registered {
const NystromPair& dprkn6_pair();
const NystromPair& dprkn8_pair();
const NystromPair& dprkn12_pair();
}  // namespace registered

}  // namespace qddot
