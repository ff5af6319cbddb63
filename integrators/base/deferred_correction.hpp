#pragma once

#include <functional>

#include "qddot/model/system.hpp"

namespace qddot {

// The integrals of polynomials that are known at the ends t = 0, 1, ..., N of N steps: of
// p(t) = sum_l p_l L_l(t), L_l Lagrange's polynomials,
//   int_j^{j+1} p(t) dt = sum_l once(j, l) p_l,
//   int_j^{j+1} (j + 1 - t) p(t) dt = sum_l twice(j, l) p_l.
struct StepIntegrals {
  Eigen::MatrixXd once, twice;  // N x (N + 1)
};
StepIntegrals step_integrals(Index steps);

// N equal steps of q'' = g(q) computed together, by deferred correction (Dutt, Greengard and
// Rokhlin, BIT 40 (2000) 241-266) with Verlet's steps (Winkel, Speck and Ruprecht, J. Comput. Phys.
// 295 (2015) 456-474): each sweep goes through all of them with the accelerations k of the sweep
// before,
//   q_{j+1} = q_j + h v_j + h^2 ((g_j - k_j)/2 + sum_l twice(j, l) k_l),
//   v_{j+1} = v_j + h ((g_j - k_j + g_{j+1} - k_{j+1})/2 + sum_l once(j, l) k_l).
// The first one, with k = 0, is Verlet's method itself. Each sweep adds two to the order, up to
// N + 1.
class DeferredCorrection {
 public:
  DeferredCorrection(Index steps, Index n);

  // acceleration(q, g) computes g(q); g0 is that of q. It is called N times a sweep, last at q_N.
  using Acceleration = std::function<void(const Vec& q, MutableVec g)>;
  void compute(const Vec& q, const Vec& v, const Vec& g0, double h, int sweeps,
               const Acceleration& acceleration);

  Index steps() const { return d_.cols(); }
  auto d(Index j) const { return d_.col(j); }  // q_{j+1} - q_j, j = 0 ... N - 1
  auto v(Index j) const { return v_.col(j); }  // j = 0 ... N
  auto g(Index j) const { return g_.col(j); }  // j = 0 ... N

 private:
  StepIntegrals integrals_;
  Eigen::MatrixXd d_, v_, g_;    // n x N, n x (N + 1), n x (N + 1)
  Eigen::MatrixXd of_v_, of_q_;  // n x N: the integrals of a sweep
  Vec q_, g_new_, change_, change_before_;
};

}  // namespace qddot
