#include "qddot/integrators/base/symmetric_formula.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "qddot/algebra/dense_pairs.hpp"

namespace qddot {
namespace {

using Complex = std::complex<double>;
using Long = long double;

// The odd palindrome with the given first half and middle.
std::vector<double> palindrome(const std::vector<std::int64_t>& half, std::int64_t denominator) {
  std::vector<double> all;
  const auto divisor = static_cast<double>(denominator);
  for (const std::int64_t number : half) all.push_back(static_cast<double>(number) / divisor);
  for (std::size_t i = half.size() - 1; i-- > 0;) all.push_back(all[i]);
  return all;
}

// The roots of sum c_i T_i(x), T_i Chebyshev's polynomials, c.back() not zero: the values of the
// matrix that multiplies by x in their basis (Good, Quarterly J. Mathematics 12 (1961) 61-68).
std::vector<std::complex<double>> chebyshev_roots(const std::vector<double>& c) {
  const Eigen::Index degree = std::ssize(c) - 1;
  Eigen::MatrixXd colleague = Eigen::MatrixXd::Zero(degree, degree);
  for (Eigen::Index i = 0; i < degree; ++i) {
    if (i + 1 < degree) colleague(i, i + 1) = i == 0 ? 1 : 0.5;
    if (i > 0) colleague(i, i - 1) = 0.5;
  }
  const double scale = (degree == 1 ? 1 : 0.5) / c.back();
  for (Eigen::Index j = 0; j < degree; ++j) {
    colleague(degree - 1, j) -= scale * c[static_cast<std::size_t>(j)];
  }
  const Eigen::VectorXcd values = general_values(colleague);
  return {values.begin(), values.end()};
}

}  // namespace

std::vector<double> SymmetricFormula::all_rho() const { return palindrome(rho, rho_denominator); }

std::vector<double> SymmetricFormula::all_beta() const {
  return palindrome(beta, beta_denominator);
}

std::vector<double> SymmetricFormula::cofactor() const {
  // Divided by z - 1 twice, exactly, as whole numbers.
  std::vector<std::int64_t> quotient = rho;
  for (std::size_t i = rho.size() - 1; i-- > 0;) quotient.push_back(rho[i]);
  for (int turn = 0; turn < 2; ++turn) {
    for (std::size_t i = 1; i < quotient.size(); ++i) quotient[i] += quotient[i - 1];
    quotient.pop_back();
  }
  std::vector<double> r;
  for (const std::int64_t number : quotient) {
    r.push_back(static_cast<double>(number) / static_cast<double>(rho_denominator));
  }
  return r;
}

// Backward differences give g(t_N - s h) = sum_i binomial(i - 1 - s, i) nabla^i g_{N - first} with
// s counted from `first`. The weights are the integrals of these polynomials in
// q(t_N - h) = q_N - h v_N + h^2 int_0^1 (1 - s) g(t_N - s h) ds.
std::vector<double> velocity_weights(int first, int count) {
  std::vector<double> weights(static_cast<std::size_t>(count));
  std::vector<Long> polynomial = {1};  // binomial(i - 1 - (s - first), i) in powers of s
  for (int i = 0; i < count; ++i) {
    Long integral = 0;
    for (std::size_t p = 0; p < polynomial.size(); ++p) {
      integral += polynomial[p] / static_cast<Long>((p + 1) * (p + 2));
    }
    Long binomial = 1;  // of i and j, with the sign of g_{N - first - j} in nabla^i
    for (int j = 0; j <= i; ++j) {
      weights[static_cast<std::size_t>(j)] += static_cast<double>(binomial * integral);
      binomial *= -static_cast<Long>(i - j) / (j + 1);
    }
    // times (i + first - s)/(i + 1)
    std::vector<Long> next(polynomial.size() + 1);
    for (std::size_t p = 0; p < polynomial.size(); ++p) {
      next[p] += polynomial[p] * (i + first) / (i + 1);
      next[p + 1] -= polynomial[p] / (i + 1);
    }
    polynomial = next;
  }
  return weights;
}

SymmetricStart symmetric_start(const SymmetricFormula& formula) {
  using Matrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;
  const std::vector<double> r = formula.cofactor(), beta = formula.all_beta();
  const Eigen::Index m = formula.steps - 2;
  // Each u and each difference is a row of 2m numbers: a combination of the m numbers u_0, u_{-1},
  // ... and of h^2 g_1, h^2 g_2, ...
  Matrix u = Matrix::Zero(2 * m, 2 * m);  // u_{1-m} ... u_m
  Matrix difference = Matrix::Zero(m, 2 * m);
  for (Eigen::Index l = 0; l < m; ++l) u(m - 1 - l, l) = 1;
  for (Eigen::Index n = 0; n < m; ++n) {
    u(m + n, m + n) = 1;
    for (Eigen::Index i = 1; i <= m; ++i) {
      u.row(m + n) -= static_cast<Long>(r[static_cast<std::size_t>(i)]) * u.row(m + n - i);
    }
    for (Eigen::Index i = 0; i <= m; ++i) {
      difference.row(n) += static_cast<Long>(beta[static_cast<std::size_t>(i)]) * u.row(m + n - i);
    }
  }
  const Eigen::PartialPivLU<Matrix> solver(difference.leftCols(m));
  const Matrix inverse = solver.inverse();
  return {inverse.cast<double>(), (-inverse * difference.rightCols(m)).cast<double>()};
}

std::vector<Complex> roots_of(const SymmetricFormula& formula, double h_omega) {
  std::vector<double> sum = formula.all_rho();
  const std::vector<double> beta = formula.all_beta();
  for (std::size_t j = 0; j < beta.size(); ++j) sum[j + 1] += h_omega * h_omega * beta[j];
  std::vector<Complex> roots;
  for (const Complex x : cosines_of_roots(sum)) {
    if (x.imag() == 0 && std::abs(x.real()) <= 1) {
      const double angle = std::acos(x.real());
      roots.push_back(std::polar(1.0, angle));
      roots.push_back(std::polar(1.0, -angle));
    } else {
      const Complex root = x + std::sqrt(x * x - 1.0);
      roots.push_back(root);
      roots.push_back(1.0 / root);
    }
  }
  const auto is_before = [h_omega](const Complex& a, const Complex& b) {
    constexpr double one_modulus = 1e-12;  // up to rounding
    const double longer = std::abs(a) - std::abs(b);
    if (std::abs(longer) > one_modulus) return longer > 0;
    return std::abs(std::abs(std::arg(a)) - h_omega) < std::abs(std::abs(std::arg(b)) - h_omega);
  };
  std::ranges::stable_sort(roots, is_before);
  return roots;
}

// Divided by z^d, the palindrome is p_d + sum 2 p_{d+i} T_i((z + 1/z)/2).
std::vector<std::complex<double>> cosines_of_roots(const std::vector<double>& palindrome) {
  const std::size_t middle = palindrome.size() / 2;
  std::vector<double> c(palindrome.begin() + static_cast<std::ptrdiff_t>(middle), palindrome.end());
  for (std::size_t i = 1; i < c.size(); ++i) c[i] *= 2;
  return chebyshev_roots(c);
}

}  // namespace qddot
