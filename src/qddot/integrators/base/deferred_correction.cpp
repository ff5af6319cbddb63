#include "qddot/integrators/base/deferred_correction.hpp"

#include <span>

#include "qddot/model/vector_updates.hpp"

namespace qddot {

// L_l is the product of (s + j - m)/(l - m) over all m other than l, with s = t - j in 0 ... 1. No
// power of s is large there, and no digits are lost.
StepIntegrals step_integrals(Index steps) {
  using Long = long double;
  StepIntegrals result{Eigen::MatrixXd(steps, steps + 1), Eigen::MatrixXd(steps, steps + 1)};
  for (Index j = 0; j < steps; ++j) {
    for (Index l = 0; l <= steps; ++l) {
      std::vector<Long> polynomial = {1};  // in powers of s
      for (Index m = 0; m <= steps; ++m) {
        if (m == l) continue;
        polynomial.push_back(0);
        const auto zero = static_cast<Long>(m - j), divisor = static_cast<Long>(l - m);
        for (std::size_t p = polynomial.size(); p-- > 0;) {
          const Long lower = p > 0 ? polynomial[p - 1] : 0;
          polynomial[p] = (lower - zero * polynomial[p]) / divisor;
        }
      }
      Long once = 0, twice = 0;
      for (std::size_t p = 0; p < polynomial.size(); ++p) {
        const auto n = static_cast<Long>(p + 1);
        once += polynomial[p] / n;
        twice += polynomial[p] / (n * (n + 1));
      }
      result.once(j, l) = static_cast<double>(once);
      result.twice(j, l) = static_cast<double>(twice);
    }
  }
  return result;
}

DeferredCorrection::DeferredCorrection(Index steps, Index n)
    : d_(n, steps), e_(n, steps), v_(n, steps + 1), g_(n, steps + 1), k_(n, steps + 1), q_(n) {
  const auto [once, twice] = step_integrals(steps);
  for (Index j = 0; j < steps; ++j) {
    Eigen::RowVectorXd row = twice.row(j);
    if (j > 0) row += once.row(j - 1) - twice.row(j - 1);
    row[j] -= j > 0 ? 1 : 0.5;
    of_e_.emplace_back(row.begin(), row.end());
    row = once.row(j);
    of_v_.emplace_back(row.begin(), row.end());
  }
}

void DeferredCorrection::compute(const Vec& q, const Vec& v, const Vec& g0, double h, int sweeps,
                                 const Acceleration& acceleration) {
  g_.col(0) = k_.col(0) = g0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (sweep > 0) g_.swap(k_);
    q_ = q;
    for (Index j = 0; j < steps(); ++j) {
      const std::vector<double>& all = of_e_[static_cast<std::size_t>(j)];
      const std::span<const double> of_k(all.data(), sweep > 0 ? all.size() : 0);
      if (j == 0) {
        d_.col(0) = h * v;
        add_combination(d_.col(0), 0.5 * h * h, g0, h * h, k_, of_k, d_.col(0));
      } else {
        set_combination(h * h, k_, of_k, e_.col(j));
        add_scaled(e_.col(j), h * h, g_.col(j), e_.col(j));
        add_scaled(d_.col(j - 1), 1, e_.col(j), d_.col(j));
      }
      add_scaled(q_, 1, d_.col(j), q_);
      acceleration(static_cast<double>(j + 1) * h, q_, g_.col(j + 1));
    }
  }
  v_.col(0) = v;
  for (Index j = 0; j < steps(); ++j) {
    add_combination(v_.col(j), h, g_, of_v_[static_cast<std::size_t>(j)], v_.col(j + 1));
  }
}

}  // namespace qddot
