#pragma once

#include <array>
#include <cmath>
#include <span>

#include "qddot/model/vector_updates.hpp"

namespace qddot {

// A polynomial of vectors, sum_j c_j x^j with the columns c_j of a matrix, at a number x.
class Powers {
 public:
  static constexpr std::size_t most = 8;

  Powers(double x, Index terms) : terms_(static_cast<std::size_t>(terms)) {
    power_[0] = 1;
    for (std::size_t j = 1; j < terms_; ++j) power_[j] = x * power_[j - 1];
  }
  std::span<const double> values() const { return {power_.data(), terms_}; }

 private:
  std::size_t terms_;
  std::array<double, most> power_;
};

// Steps of
//   x'' = M^-1 f(x) + p(t),   p = c_0 + c_1 t/h + c_2 (t/h)^2 + ...
// from t = 0 to h: the motion that stiff forces f alone make, pushed by a polynomial.
//   order 2  position Verlet; stable up to steps of 2/w_max
//   order 4  two drifts between kicks of 1/6, 2/3 and 1/6 of a step, of which the middle one is of
//            the acceleration a at x + t^2/24 a(x), t the step; three forces a step, stable up to
//            3.46/w_max (Chin, Physics Letters A 226 (1997) 344-348, algorithm A)
template <int order>
class StiffFlow {
  static_assert(order == 2 || order == 4);

 public:
  // The part of the limit that leaves room for what w_max grows by in motion, times w_max.
  static constexpr double step_times_frequency = order == 2 ? 1.8 : 3.0;

  explicit StiffFlow(const Vec& mass) : mass_(mass), f_(mass.size()), y_(mass.size()) {}

  // `force(x, f)` computes f [N]; `push` has the c_j [m/s^2] in its columns. x, v: n, from those at
  // t = 0 to those at h [s].
  template <class Force>
  void advance(double h, double steps, const Eigen::MatrixXd& push, const Force& force, Vec& x,
               Vec& v) {
    const double tau = h / steps;
    // v += c a(at), of which f has the force already, i steps after the start.
    const auto kick = [&](double c, double i) {
      add_quotient(v, c, f_, mass_, v);
      add_combination(v, c, push, Powers(i / steps, push.cols()).values(), v);
    };
    if constexpr (order == 2) {
      add_scaled(x, tau / 2, v, x);
      for (double i = 0; i < steps; ++i) {
        force(x, f_);
        kick(tau, i + 0.5);
        add_scaled(x, i + 1 < steps ? tau : tau / 2, v, x);
      }
    } else {
      force(x, f_);
      for (double i = 0; i < steps; ++i) {
        kick(i > 0 ? tau / 3 : tau / 6, i);
        add_scaled(x, tau / 2, v, x);
        force(x, f_);
        const Powers powers((i + 0.5) / steps, push.cols());
        add_quotient(x, tau * tau / 24, f_, mass_, y_);
        add_combination(y_, tau * tau / 24, push, powers.values(), y_);
        force(y_, f_);
        kick(2 * tau / 3, i + 0.5);
        add_scaled(x, tau / 2, v, x);
        force(x, f_);
      }
      kick(tau / 6, steps);
    }
  }

 private:
  const Vec& mass_;
  Vec f_, y_;
};

}  // namespace qddot
