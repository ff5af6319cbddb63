#pragma once

#include <type_traits>

#include <Eigen/Core>

#include "qddot/model/capabilities.hpp"
#include "qddot/model/spring.hpp"

namespace qddot {

// A dashpot by the rate of its length: the force on its end i [N] and its power [W]. One of rest
// length zero resists in all directions, by the rate of d.
template <int D>
struct SecantDashpot {
  Eigen::Matrix<double, D, 1> force;
  double power;
};
template <int D, class Law>
SecantDashpot<D> secant_dashpot(const Law& law, const Eigen::Matrix<double, D, 1>& d0,
                                const Eigen::Matrix<double, D, 1>& d1,
                                const Eigen::Matrix<double, D, 1>& d2, const BackwardRate& rate) {
  if constexpr (std::is_same_v<Law, SpringLaw>) {
    if (law.is_slack(d0.norm())) return {Eigen::Matrix<double, D, 1>::Zero(), 0};
  }
  if (D == 1 || law.rest_length == 0) {
    const Eigen::Matrix<double, D, 1> w = rate.a0 * d0 + rate.a1 * d1 + rate.a2 * d2;
    return {law.damping * w, law.damping * w.squaredNorm()};
  }
  const double length = d0.norm();
  const double l_rate = rate.a0 * length + rate.a1 * d1.norm() + rate.a2 * d2.norm();
  const double along = length > 0 ? law.damping * l_rate / length : 0;
  return {along * d0, law.damping * l_rate * l_rate};
}

}  // namespace qddot
