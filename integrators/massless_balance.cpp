#include "qddot/integrators/massless_balance.hpp"

#include <algorithm>
#include <cmath>

namespace qddot {

MasslessBalance::MasslessBalance(const System& system, double tolerance)
    : tolerance_(tolerance), k_(system.stiffness_pattern()) {
  std::vector<Index> place(static_cast<std::size_t>(system.size()), -1);
  Index count = 0;
  for (Index i = 0; i < system.size(); ++i) {
    if (system.mass()[i] == 0) place[i] = count++;
  }
  own_.resize(count, count);
  Index entry = 0;
  for (Index column = 0; column < k_.outerSize(); ++column) {
    if (place[column] >= 0) own_.startVec(place[column]);
    for (SymmetricMatrix::InnerIterator at(k_, column); at; ++at, ++entry) {
      if (place[column] < 0 || place[at.row()] < 0) continue;
      if (at.row() == column) diagonals_.push_back(std::ssize(source_));
      own_.insertBack(place[at.row()], place[column]) = 0;
      source_.push_back(entry);
    }
  }
  own_.finalize();
  scale_.resize(count);
  factors_.analyzePattern(own_);
}

bool MasslessBalance::is_stable() {
  for (std::size_t e = 0; e < source_.size(); ++e) {
    own_.valuePtr()[e] = -k_.valuePtr()[source_[e]];
  }
  // A direction across a straight row of springs is soft; what it is compared with is the stiffest
  // one of its node and of those beside it.
  const Index count = own_.cols();
  const auto diagonal = [&](Index i) { return std::abs(own_.valuePtr()[diagonals_[i]]); };
  for (Index i = 0; i < count; ++i) scale_[i] = diagonal(i);
  for (Index column = 0; column < count; ++column) {
    for (SymmetricMatrix::InnerIterator at(own_, column); at; ++at) {
      scale_[column] = std::max(scale_[column], diagonal(at.row()));
      scale_[at.row()] = std::max(scale_[at.row()], diagonal(column));
    }
  }
  for (Index i = 0; i < count; ++i) {
    own_.valuePtr()[diagonals_[i]] += scale_[i] > 0 ? tolerance_ * scale_[i] : 1;
  }
  factors_.factorize(own_);
  return factors_.info() == Eigen::Success && factors_.vectorD().minCoeff() > 0;
}

}  // namespace qddot
