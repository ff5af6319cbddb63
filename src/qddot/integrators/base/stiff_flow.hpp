#pragma once

#include <array>
#include <span>

#include "qddot/model/vector_updates.hpp"

namespace qddot {

// Steps of
//   M x'' = f(x) + p(t),   p = c_0 + c_1 t/h + c_2 (t/h)^2 + ...
// from t = 0 to h: the motion by stiff forces f alone, pushed by a polynomial p.
//   order 2  position Verlet; stable up to steps of 2/w_max
//   order 4  two drifts between kicks of 1/6, 2/3 and 1/6 of a step. The middle kick is by the
//            force at x + t^2/24 a(x), t the step and a the acceleration. Three forces a step,
//            stable up to 3.46/w_max (Chin, Physics Letters A 226 (1997) 344-348, algorithm A).
template <int order>
class StiffFlow {
  static_assert(order == 2 || order == 4);

 public:
  // The largest step times w_max, with room for changes of w_max along the motion.
  static constexpr double largest_step_times_frequency = order == 2 ? 1.8 : 3.0;

  // `coefficients`: their number in p, at most 7.
  StiffFlow(const Mass& mass, int coefficients)
      : mass_(mass),
        coefficients_(coefficients),
        forces_(mass.size(), coefficients + 1),
        momentum_(mass.size()),
        shift_(mass.size()),
        shifted_(mass.size()) {}

  // c_j [N], to be filled before advance().
  Eigen::MatrixXd::ColXpr coefficient(int j) { return forces_.col(j); }

  // Takes x and v (n) from t = 0 to h [s] in `steps` equal steps; `force(x, f)` computes f [N].
  template <class Force>
  void advance(double h, double steps, const Force& force, Vec& x, Vec& v) {
    const double tau = h / steps;
    multiply(v, mass_, momentum_);
    const auto evaluate = [&](const Vec& at) { force(at, forces_.col(coefficients_)); };
    // A kick by the last f, and by p at i steps after the start.
    const auto kick = [&](double size, double i) {
      add_combination(momentum_, size, forces_, weights(i / steps), momentum_);
    };
    const auto drift = [&](double size) { add_quotient(x, size, momentum_, mass_, x); };
    if constexpr (order == 2) {
      drift(tau / 2);
      for (double i = 0; i < steps; ++i) {
        evaluate(x);
        kick(tau, i + 0.5);
        drift(i + 1 < steps ? tau : tau / 2);
      }
    } else {
      evaluate(x);
      kick(tau / 6, 0);
      for (double i = 0; i < steps; ++i) {
        drift(tau / 2);
        evaluate(x);
        set_combination(tau * tau / 24, forces_, weights((i + 0.5) / steps), shift_);
        add_quotient(x, 1, shift_, mass_, shifted_);
        evaluate(shifted_);
        kick(2 * tau / 3, i + 0.5);
        drift(tau / 2);
        evaluate(x);
        kick(i + 1 < steps ? tau / 3 : tau / 6, i + 1);
      }
    }
    divide(momentum_, mass_, v);
  }

 private:
  // The weights of the columns at t = x h: powers of x, and 1 for f.
  std::span<const double> weights(double x) {
    double power = 1;
    for (int j = 0; j < coefficients_; ++j, power *= x) {
      weights_[static_cast<std::size_t>(j)] = power;
    }
    weights_[static_cast<std::size_t>(coefficients_)] = 1;
    return {weights_.data(), static_cast<std::size_t>(coefficients_) + 1};
  }

  const Mass& mass_;
  int coefficients_;
  Eigen::MatrixXd forces_;  // the coefficients, and f
  Vec momentum_, shift_, shifted_;
  std::array<double, 8> weights_{};
};

}  // namespace qddot
