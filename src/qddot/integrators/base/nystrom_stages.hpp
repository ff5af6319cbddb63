#pragma once

#include <algorithm>
#include <vector>

#include "qddot/model/vector_updates.hpp"

namespace qddot {

// The coefficients of an embedded explicit Runge-Kutta-Nystrom pair of s stages for q'' = g(q),
//   q_i = q_n + c_i h v_n + h^2 sum_{j<i} a_ij k_j,   k_i = g(q_i),
//   q_{n+1} = q_n + h v_n + h^2 sum_i b_i k_i,   v_{n+1} = v_n + h sum_i b'_i k_i
// (Hairer, Norsett and Wanner, Solving ODEs I, section II.14). The lower b and b' estimate the
// errors.
struct NystromPair {
  int order = 0, lower_order = 0;
  // The largest h w up to which no vibration q'' = -w^2 q grows by more than a hundredth a step.
  double stable_hw = 0;
  std::vector<double> c{};
  std::vector<std::vector<double>> a{};  // row i holds i entries
  std::vector<double> b{}, b_prime{}, lower_b{}, lower_b_prime{};

  // Whether the last stage is the first one of the next step: q_s = q_{n+1}.
  bool is_first_same_as_last() const {
    return c.back() == 1 && std::equal(a.back().begin(), a.back().end(), b.begin()) &&
           b.back() == 0;
  }
};

// The accelerations k_1 ... k_s of one step of a pair for n unknowns; s - 1 of them are computed.
class NystromStages {
 public:
  NystromStages(const NystromPair& pair, Index n)
      : pair_(pair), k_(n, std::ssize(pair.b)), stage_(n) {}

  // Computes the stages of a step h [s] from q and v, where the acceleration is a;
  // acceleration(t, q, k) computes another, t [s] after the start of the step.
  template <class Acceleration>
  void compute(const Vec& q, const Vec& v, const Vec& a, double h,
               const Acceleration& acceleration) {
    k_.col(0) = a;
    for (Index i = 1; i < k_.cols(); ++i) {
      const auto row = static_cast<std::size_t>(i);
      add_combination(q, pair_.c[row] * h, v, h * h, k_, pair_.a[row], stage_);
      acceleration(pair_.c[row] * h, stage_, k_.col(i));
    }
  }
  const Eigen::MatrixXd& k() const { return k_; }  // n x s

 private:
  const NystromPair& pair_;
  Eigen::MatrixXd k_;
  Vec stage_;
};

}  // namespace qddot
