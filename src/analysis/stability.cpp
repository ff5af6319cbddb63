#include "src/analysis/stability.hpp"

#include <stdexcept>

#include "src/algebra/effective_mass.hpp"
#include "src/analysis/natural_modes.hpp"

namespace qddot {
namespace {

constexpr double threshold = 1e-10;
constexpr int most_raises = 20;

Vec row_sums(const SymmetricMatrix& k) {
  const SymmetricMatrix sizes = k.cwiseAbs();
  return sizes.selfadjointView<Eigen::Lower>() * Vec::Ones(k.rows());
}

}  // namespace

Vec metric_of_all(const System& system) {
  const Vec& mass = system.mass();
  const auto massive = (mass.array() > 0).count();
  const double mean = massive > 0 ? mass.sum() / static_cast<double>(massive) : 1;
  return (mass.array() > 0).select(mass, mean);
}

int unstable_directions(const System& system, const Vec& q) {
  if (system.size() == 0) return 0;
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  const Vec metric = metric_of_all(system);
  const double bound = row_sums(k).cwiseQuotient(metric).maxCoeff();
  if (bound == 0) return 0;
  EffectiveMass matrix(system, metric);
  // LDL' without pivoting can meet a pivot that is zero, but hardly with several tau.
  double tau = threshold * bound;
  for (int tries = 0; tries < most_raises; ++tries, tau *= 1.1) {
    if (matrix.factorize(tau, 1, k) == EffectiveMass::Definiteness::singular) continue;
    return static_cast<int>(matrix.negative_pivots());
  }
  throw std::runtime_error("the stiffness matrix cannot be factorised, so its signs are not known");
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
