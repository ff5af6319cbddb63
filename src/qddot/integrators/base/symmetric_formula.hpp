#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "qddot/integrators/base/nystrom_stages.hpp"

namespace qddot {

// A symmetric multistep formula of k steps, k even, for q'' = g(q):
//   sum_{j=0}^k rho_j q_{n+j} = h^2 sum_{j=1}^{k-1} beta_j g(q_{n+j}),
// with rho_j = rho_{k-j} and beta_j = beta_{k-j}. It takes one g a step and has order k. Its
// polynomial is rho(z) = (z - 1)^2 r(z). The roots of r lie on the unit circle, apart from each
// other (Lambert and Watson, J. Inst. Maths Applics 18 (1976) 189-202; Quinlan and Tremaine,
// Astronomical Journal 100 (1990) 1694-1700). All roots of rho(z) + h^2 w^2 beta(z), which decide
// q'' = -w^2 q, stay on the circle up to a limit of h w. So no vibration grows or dies.
//
// Coefficients are exact: whole numbers over one denominator each.
struct SymmetricFormula {
  int steps;  // k
  std::int64_t rho_denominator;
  std::vector<std::int64_t> rho;  // rho_k ... rho_{k/2}, half of them
  std::int64_t beta_denominator;
  std::vector<std::int64_t> beta;       // beta_{k-1} ... beta_{k/2}
  const NystromPair& (*single_step)();  // a step of another length, of order k or more

  // All coefficients as numbers, rho_k ... rho_0 and beta_{k-1} ... beta_1.
  std::vector<double> all_rho() const;
  std::vector<double> all_beta() const;
  // The coefficients of r: r_0 = 1, ..., r_{k-2} = 1.
  std::vector<double> cofactor() const;
};

// The weights of the last accelerations in a velocity: h v_N = q_N - q_{N-1} + h^2 sum w_j g_{N-j},
// with j = first, ..., first + count - 1. Exact if g is a polynomial of degree count - 1 in time.
std::vector<double> velocity_weights(int first, int count);

// The weights that begin the steps of a formula. Let E be the shift by a step and h^2 g = r(E) u;
// then second differences of q are e = beta(E) u. The u before the start make the first k - 2
// differences those of known steps:
//   u_{-l} = sum_n of_differences(l, n) (q_{n+2} - 2 q_{n+1} + q_n) + of_forces(l, n) h^2 g_{n+1},
// l and n = 0 ... k - 3.
struct SymmetricStart {
  Eigen::MatrixXd of_differences, of_forces;
};
// These weights for a formula.
SymmetricStart symmetric_start(const SymmetricFormula& formula);

// The k roots of rho(z) + h^2 w^2 beta(z). Those farthest outside of the unit circle come first;
// among those on it, the pair nearest to the exact exp(+- i h w). The sum is a polynomial of
// (z + 1/z)/2, which is the cosine of the angle of a z on the circle.
std::vector<std::complex<double>> roots_of(const SymmetricFormula& formula, double h_omega);

// The cosines (z + 1/z)/2 of the roots z of a palindrome p_0 + p_1 z + ... + p_{2d} z^{2d},
// p_i = p_{2d-i}, p_0 not zero. There are d, one for each pair z and 1/z, in no order. A pair on
// the unit circle has a real cosine from -1 to 1.
std::vector<std::complex<double>> cosines_of_roots(const std::vector<double>& palindrome);

}  // namespace qddot
