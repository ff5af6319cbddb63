#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "qddot/integrators/base/nystrom_stages.hpp"

namespace qddot {

// A symmetric multistep formula for q'' = g(q) of k steps, k even:
//   sum_{j=0}^k rho_j q_{n+j} = h^2 sum_{j=1}^{k-1} beta_j g(q_{n+j}),
// with rho_j = rho_{k-j} and beta_j = beta_{k-j}, one g a step and order k. Its polynomial is
// rho(z) = (z - 1)^2 r(z), where the roots of r lie on the unit circle, apart from each other
// (Lambert and Watson, J. Inst. Maths Applics 18 (1976) 189-202; Quinlan and Tremaine, Astronomical
// Journal 100 (1990) 1694-1700). On q'' = -w^2 q all roots of rho(z) + h^2 w^2 beta(z) stay on the
// circle, and no vibration grows or dies, up to a limit of h w.
//
// Coefficients are exact: whole numbers over one denominator each.
struct SymmetricFormula {
  int steps;  // k
  std::int64_t rho_denominator;
  std::vector<std::int64_t> rho;  // rho_k ... rho_{k/2}, half of them
  std::int64_t beta_denominator;
  std::vector<std::int64_t> beta;       // beta_{k-1} ... beta_{k/2}
  const NystromPair& (*single_step)();  // of a step of another length, of order k at least

  // All of them as numbers, rho_k ... rho_0 and beta_{k-1} ... beta_1.
  std::vector<double> all_rho() const;
  std::vector<double> all_beta() const;
  // r: r_0 = 1, ..., r_{k-2} = 1.
  std::vector<double> cofactor() const;
};

// The weights of the last accelerations in a velocity: h v_N = q_N - q_{N-1} + h^2 sum w_j g_{N-j},
// with j = first, ..., first + count - 1. Exact where g is a polynomial of degree count - 1 in
// time.
std::vector<double> velocity_weights(int first, int count);

// How the steps of a formula begin. With h^2 g = r(E) u, E the shift by a step, second differences
// of q are e = beta(E) u; the u before the start are those for which the first k - 2 differences
// are those of steps that are known:
//   u_{-l} = sum_n of_differences(l, n) (q_{n+2} - 2 q_{n+1} + q_n) + of_forces(l, n) h^2 g_{n+1},
// l and n = 0 ... k - 3.
struct SymmetricStart {
  Eigen::MatrixXd of_differences, of_forces;
};
SymmetricStart symmetric_start(const SymmetricFormula& formula);

// The k roots of rho(z) + h^2 w^2 beta(z): those farthest outside of the unit circle first, and of
// those on it the pair that is nearest to the exact exp(+- i h w). With z on the circle,
// (z + 1/z)/2 is the cosine of its angle, and the sum is a polynomial of that.
std::vector<std::complex<double>> roots_of(const SymmetricFormula& formula, double h_omega);

}  // namespace qddot
