#pragma once

#include <optional>
#include <vector>

#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// The shares of the natural modes in the kinetic energy T of a motion. The modes x_j are those at
// equilibrium, -K x_j = w_j^2 M x_j with x_i'Mx_j = delta_ij:
//   T_j = 1/2 (x_j'M v)^2,   T = sum_j T_j at any amplitude.
// Potential energies 1/2 w_j^2 (x_j'M (q - q_eq))^2 are not used: they would take the rotation of a
// cloth for stretching. The lowest modes have a share each, all others share one.
class ModalShares {
 public:
  static constexpr Index most_modes = 32;

  // Empty if no equilibrium is reached from the start.
  static std::optional<ModalShares> at_equilibrium(const Model& scene);

  // T_j [J]; the last entry is the sum over all higher modes. There are up to most_modes + 1
  // entries.
  Vec kinetic(const Vec& v) const;
  // The mean T_j over the states of the second half of the path (by time), divided by their sum.
  Vec mean(const std::vector<State>& path) const;

 private:
  ModalShares(const Vec& mass, const Eigen::MatrixXd& shapes);

  Vec mass_;
  Eigen::MatrixXd impulses_;  // M x_j, one column for each mode
};

// The total variation distance 1/2 sum |a_j - b_j| of two distributions: from 0 to 1.
double total_variation(const Vec& a, const Vec& b);

}  // namespace qddot::inline measure
