#include "src/analysis/frequency_bound.hpp"

#include <cmath>

namespace qddot {

double frequency_bound(const System& system, const Vec& q) {
  if (system.size() == 0) return 0;
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  k = k.cwiseAbs();
  const Vec row_sums = k.selfadjointView<Eigen::Lower>() * Vec::Ones(system.size());
  double largest = 0;
  for (Index i = 0; i < system.size(); ++i) {
    if (row_sums[i] > 0) largest = std::max(largest, row_sums[i] / system.mass()[i]);
  }
  return std::sqrt(largest);
}

}  // namespace qddot
