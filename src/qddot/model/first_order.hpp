#pragma once

#include <cstdint>
#include <vector>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// The pattern of the 2n x 2n matrices of the first-order form y = (q, v), y' = (v, M^-1 f(q)):
//   [ alpha I   beta I ]
//   [ diag(s) K   diag(e) - diag(s) C ],
// with the pattern of K in place of that of C; without C if the system has no Damping.
// It is for solvers that take any sparse matrix: compressed columns, full, rows ascending, every
// diagonal entry stored. The Jacobian dy'/dy has alpha = 0, beta = 1, s = 1/m, e = 0. The matrix
// dF/dy + c dF/dy' of the implicit form F = (q' - v, M v' - f) has alpha = c, beta = -1, s = -1,
// e = c m.
class FirstOrderPattern {
 public:
  // The pattern for a system that computes K.
  explicit FirstOrderPattern(const System& system);

  // The start of each column among the entries (2n + 1), and the row of each entry.
  const std::vector<std::int64_t>& column_starts() const { return column_starts_; }
  const std::vector<std::int64_t>& rows() const { return rows_; }

  // Writes the rows().size() entries into `values`. k, and C if the system has Damping, else
  // nullptr: lower triangles with the system's pattern; s, e: n.
  void fill(double alpha, double beta, const Vec& s, const SymmetricMatrix& k, const Vec& e,
            double* values, const SymmetricMatrix* damping = nullptr) const;

 private:
  std::vector<std::int64_t> column_starts_, rows_;
  std::vector<int> source_;  // the place in the lower triangle of each entry of the full K
};

}  // namespace qddot
