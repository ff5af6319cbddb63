#include "qddot/integrators/base/deferred_correction.hpp"

#include <vector>

namespace qddot {

// With s = t - j, in 0 ... 1, L_l is the product of (s + j - m)/(l - m) over all m other than l. No
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
    : integrals_(step_integrals(steps)),
      d_(n, steps),
      v_(n, steps + 1),
      g_(n, steps + 1),
      of_v_(n, steps),
      of_q_(n, steps),
      q_(n),
      g_new_(n),
      change_(n),
      change_before_(n) {}

void DeferredCorrection::compute(const Vec& q, const Vec& v, const Vec& g0, double h, int sweeps,
                                 const Acceleration& acceleration) {
  g_.setZero();
  v_.col(0) = v;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    of_q_.noalias() = g_ * integrals_.twice.transpose();
    of_v_.noalias() = g_ * integrals_.once.transpose();
    q_ = q;
    change_before_ = g0 - g_.col(0);
    g_.col(0) = g0;
    for (Index j = 0; j < steps(); ++j) {
      d_.col(j) = h * (v_.col(j) + h * (0.5 * change_before_ + of_q_.col(j)));
      q_ += d_.col(j);
      acceleration(q_, g_new_);
      change_ = g_new_ - g_.col(j + 1);
      g_.col(j + 1) = g_new_;
      v_.col(j + 1) = v_.col(j) + h * (0.5 * (change_before_ + change_) + of_v_.col(j));
      change_before_.swap(change_);
    }
  }
}

}  // namespace qddot
