#pragma once

#include <functional>
#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// Integrals of a polynomial p with known values p_l at the ends t = 0, 1, ..., N of N steps.
// p(t) = sum_l p_l L_l(t), L_l being Lagrange's polynomials:
//   int_j^{j+1} p(t) dt = sum_l once(j, l) p_l,
//   int_j^{j+1} (j + 1 - t) p(t) dt = sum_l twice(j, l) p_l.
struct StepIntegrals {
  Eigen::MatrixXd once, twice;  // N x (N + 1)
};
// These integrals for N = `steps`.
StepIntegrals step_integrals(Index steps);

// N equal steps of q'' = g(q), computed together by deferred correction (Dutt, Greengard and
// Rokhlin, BIT 40 (2000) 241-266) with Verlet's method (Winkel, Speck and Ruprecht, J. Comput.
// Phys. 295 (2015) 456-474). It is written in differences d_j = q_{j+1} - q_j, e_j = d_j - d_{j-1}.
// Each sweep goes through all steps and integrates exactly the polynomial through the accelerations
// k of the last sweep:
//   d_0 = h v_0 + h^2 ((g_0 - k_0)/2 + int_0^1 (1 - t) k(t) dt),
//   e_j = h^2 (g_j - k_j + int_{j-1}^{j+1} (1 - |t - j|) k(t) dt).
// The first sweep, with k = 0, is Verlet's method itself. Each sweep adds two to the order, up to
// N + 1. The velocities v_{j+1} = v_j + h int_j^{j+1} g(t) dt are computed at the end.
class DeferredCorrection {
 public:
  DeferredCorrection(Index steps, Index n);

  // Computes the steps of h [s] from q and v (n); g0 = g(q). acceleration(t, q, g) computes
  // g(q), t [s] after the start. It is called N times a sweep, last at q_N.
  using Acceleration = std::function<void(double t, const Vec& q, MutableVec g)>;
  void compute(const Vec& q, const Vec& v, const Vec& g0, double h, int sweeps,
               const Acceleration& acceleration);

  Index steps() const { return d_.cols(); }
  auto d(Index j) const { return d_.col(j); }  // j = 0 ... N - 1
  auto e(Index j) const { return e_.col(j); }  // j = 1 ... N - 1
  auto v(Index j) const { return v_.col(j); }  // j = 0 ... N
  auto g(Index j) const { return g_.col(j); }  // j = 0 ... N

 private:
  std::vector<std::vector<double>> of_e_, of_v_;  // the weights of k in e_j, of g in v_j+1
  Eigen::MatrixXd d_, e_, v_, g_, k_;             // n x N twice, n x (N + 1)
  Vec q_;
};

}  // namespace qddot
