#include "qddot/model/first_order.hpp"

namespace qddot {

FirstOrderPattern::FirstOrderPattern(const System& system) {
  // A lower triangle whose values are their own entry numbers, completed by its transpose.
  const SymmetricMatrix& lower = system.stiffness_pattern();
  SymmetricMatrix numbered = lower;
  for (int p = 0; p < numbered.nonZeros(); ++p) numbered.valuePtr()[p] = p;
  const SymmetricMatrix full = numbered.selfadjointView<Eigen::Lower>();

  const Index n = system.size();
  column_starts_.push_back(0);
  for (Index column = 0; column < n; ++column) {
    rows_.push_back(column);
    for (SymmetricMatrix::InnerIterator entry(full, column); entry; ++entry) {
      rows_.push_back(n + entry.row());
      source_.push_back(static_cast<int>(entry.value()));
    }
    column_starts_.push_back(std::ssize(rows_));
  }
  for (Index column = 0; column < n; ++column) {
    rows_.push_back(column);
    if (system.damping()) {
      for (SymmetricMatrix::InnerIterator entry(full, column); entry; ++entry) {
        rows_.push_back(n + entry.row());
      }
    } else {
      rows_.push_back(n + column);
    }
    column_starts_.push_back(std::ssize(rows_));
  }
}

void FirstOrderPattern::fill(double alpha, double beta, const Vec& s, const SymmetricMatrix& k,
                             const Vec& e, double* values, const SymmetricMatrix* damping) const {
  const Index n = s.size();
  const double* entries = k.valuePtr();
  const int* source = source_.data();
  for (Index column = 0; column < n; ++column) {
    std::int64_t p = column_starts_[column];
    values[p++] = alpha;
    for (; p < column_starts_[column + 1]; ++p) values[p] = s[rows_[p] - n] * entries[*source++];
  }
  double* value = values + column_starts_[n];
  if (damping) {
    const double* c = damping->valuePtr();
    source = source_.data();
    for (Index column = 0; column < n; ++column) {
      std::int64_t p = column_starts_[n + column];
      values[p++] = beta;
      for (; p < column_starts_[n + column + 1]; ++p) {
        const std::int64_t row = rows_[p] - n;
        values[p] = (row == column ? e[column] : 0) - s[row] * c[*source++];
      }
    }
    return;
  }
  for (Index column = 0; column < n; ++column) {
    *value++ = beta;
    *value++ = e[column];
  }
}

}  // namespace qddot
