#include "src/analysis/frequency_bound.hpp"

#include <cmath>

namespace qddot {

double frequency_bound(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  return frequency_bound(system.mass(), k);
}

double frequency_bound(const Vec& mass, const SymmetricMatrix& k) {
  if (mass.size() == 0) return 0;
  const SymmetricMatrix sizes = k.cwiseAbs();
  const Vec row_sums = sizes.selfadjointView<Eigen::Lower>() * Vec::Ones(mass.size());
  double largest = 0;
  for (Index i = 0; i < mass.size(); ++i) {
    if (row_sums[i] > 0) largest = std::max(largest, row_sums[i] / mass[i]);
  }
  return std::sqrt(largest);
}

}  // namespace qddot
