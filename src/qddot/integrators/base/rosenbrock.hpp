#pragma once

#include <vector>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/integrators/base/adaptive_step.hpp"

namespace qddot {

// A Rosenbrock method for y' = F(y) in the form of Hairer and Wanner, Solving ODEs II, eq. IV.7.25:
//   (1/(gamma h) - J) U_i = F(y_n + sum_j a_ij U_j) + 1/h sum_j c_ij U_j,  j < i.
// Its step is y_{n+1} = y_n + sum_j a_sj U_j + U_s with the a of the last stage (it is stiffly
// accurate). Its error estimate is U_s.
struct RosenbrockTable {
  double gamma;
  std::vector<std::vector<double>> a, c;  // rows i = 0, 1, ..., with i entries
};

// Steps of such a method for y = (q, v), F = (v, M^-1 f(q)), with the exact
// J = [[0, I], [M^-1 K, 0]], K = K(q_n). If F depends on t, stage i is at t_n + alpha_i h and has
// gamma_i h F_t(t_n, y_n) beside (eq. IV.7.12). Each stage is one n x n solve, g = gamma h:
//   (I - g J)(U_q, U_v) = (r, s)  <=>  (M - g^2 K) U_q = M (r + g s),  U_v = (U_q - r)/g.
// A step takes one factorisation, whether or not the matrix is positive definite.
class Rosenbrock final : public AdaptiveStep {
 public:
  Rosenbrock(SystemRun& run, const RosenbrockTable& table, int error_order);

 private:
  Outcome attempt(const Instant& now, double h, Instant& next, Vec& error_q, Vec& error_v) override;
  void start(const State& state) override;
  void moved() override;
  bool factorize(const At& at, double g);
  // The part of M u that an iterative solve for a stage may leave.
  double tolerance(const State& now, double g, const Vec& u) const;

  const RosenbrockTable& table_;
  Vec alpha_, gammas_;         // of the stages
  Eigen::MatrixXd u_q_, u_v_;  // n x stages
  Vec r_, s_, x_;
  SymmetricMatrix k_;
  EffectiveMass matrix_;
  Vec a_rate_;  // M^-1 df/dt
  bool has_k_ = false;
  double factorized_g_ = 0;  // 0: none
};

}  // namespace qddot
