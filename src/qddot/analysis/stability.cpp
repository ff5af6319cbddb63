#include "qddot/analysis/stability.hpp"

#include <stdexcept>

#include "qddot/analysis/natural_modes.hpp"

namespace qddot {

Vec row_sums(const SymmetricMatrix& k) {
  const SymmetricMatrix sizes = k.cwiseAbs();
  return sizes.selfadjointView<Eigen::Lower>() * Vec::Ones(k.rows());
}

Vec metric_of_all(const System& system) {
  const Vec& mass = system.mass();
  const auto massive = (mass.array() > 0).count();
  const double mean = massive > 0 ? mass.sum() / static_cast<double>(massive) : 1;
  return (mass.array() > 0).select(mass, mean);
}

Curvature smallest_curvature(const System& system, const Vec& q) {
  if (system.size() == 0) throw std::invalid_argument("no unknown, so no curvature of the energy");
  const NaturalModes lowest = lowest_modes(system, q, 1, Vec::Ones(system.size()));
  return {lowest.squares[0], lowest.shapes.col(0)};
}

double largest_row_sum(const SymmetricMatrix& k) {
  return k.rows() == 0 ? 0 : row_sums(k).maxCoeff();
}

}  // namespace qddot
