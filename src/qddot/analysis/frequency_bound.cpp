#include "qddot/analysis/frequency_bound.hpp"

#include <cmath>

#include "qddot/analysis/require_stiffness.hpp"

namespace qddot {

double frequency_bound(const System& system, const Vec& q) {
  require_stiffness(system);
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  Vec row_sums;
  return frequency_bound(system.mass(), k, row_sums);
}

double frequency_bound(const Vec& mass, const SymmetricMatrix& k, Vec& row_sums) {
  row_sums.setZero(mass.size());
  for (Index j = 0; j < k.cols(); ++j) {
    for (SymmetricMatrix::InnerIterator entry(k, j); entry; ++entry) {
      const double size = std::abs(entry.value());
      row_sums[j] += size;
      if (entry.row() != j) row_sums[entry.row()] += size;
    }
  }
  double largest = 0;
  for (Index i = 0; i < mass.size(); ++i) {
    if (row_sums[i] > 0) largest = std::max(largest, row_sums[i] / mass[i]);
  }
  return std::sqrt(largest);
}

}  // namespace qddot
