#pragma once

#include <cstdint>
#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// The pattern of the 2n x 2n matrices that belong to the first-order form y = (q, v),
// y' = (v, M^-1 f(q)), for solvers that take any sparse matrix (compressed columns, full, rows
// ascending, every diagonal entry stored):
//   [ alpha I   beta I ]
//   [ diag(s) K   diag(e) ].
// The Jacobian dy'/dy is alpha = 0, beta = 1, s = 1/m, e = 0; the matrix of an implicit form
// F = (q' - v, M v' - f) is dF/dy + c dF/dy': alpha = c, beta = -1, s = -1, e = c m.
class FirstOrderPattern {
 public:
  explicit FirstOrderPattern(const System& system);

  const std::vector<std::int64_t>& column_starts() const { return column_starts_; }
  const std::vector<std::int64_t>& rows() const { return rows_; }

  // Writes the entries, rows().size() of them. k: lower triangle with the system's pattern;
  // s, e: n.
  void fill(double alpha, double beta, const Vec& s, const SymmetricMatrix& k, const Vec& e,
            double* values) const;

 private:
  std::vector<std::int64_t> column_starts_, rows_;
  std::vector<int> source_;  // of each entry of the full K, its place in the lower triangle
};

}  // namespace qddot
