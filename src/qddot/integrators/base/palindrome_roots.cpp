#include "qddot/integrators/base/palindrome_roots.hpp"

#include <Eigen/Core>

#include "qddot/algebra/dense_pairs.hpp"

namespace qddot {
namespace {

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

// Divided by z^d, the palindrome is p_d + sum 2 p_{d+i} T_i((z + 1/z)/2).
std::vector<std::complex<double>> cosines_of_roots(const std::vector<double>& palindrome) {
  const std::size_t middle = palindrome.size() / 2;
  std::vector<double> c(palindrome.begin() + static_cast<std::ptrdiff_t>(middle), palindrome.end());
  for (std::size_t i = 1; i < c.size(); ++i) c[i] *= 2;
  return chebyshev_roots(c);
}

}  // namespace qddot
