#pragma once

#include <memory>
#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// Gives a system without K a stiffness matrix by central differences of its force:
//   K e_j = (f(q + d e_j) - f(q - d e_j)) / 2d,   d = cbrt(2^-52) max(`length`, |q|_inf).
// Columns that share no row of the pattern are displaced together (Curtis, Powell, Reid, IMA
// Journal of Applied Mathematics 13 (1974) 117-119). One K costs two forces for each such group, or
// colour. It is good to some 1e-10 of its largest entries, if forces are smooth, and is made
// symmetric.
class DifferencedStiffness final : public System {
 public:
  // `pairs`: the pairs (i, j) of unknowns that depend on each other, in any order; i = j may be
  // left out. `length` [m]: a small length of the motion, 1 by default. Throws
  // std::invalid_argument for a pair beyond the unknowns or a length that is not above 0.
  DifferencedStiffness(std::shared_ptr<const System> system,
                       const std::vector<std::pair<Index, Index>>& pairs, double length = 1);

  double potential(const At& at) const override { return system_->potential(at); }
  bool has_potential() const override { return system_->has_potential(); }
  void force(const At& at, MutableVec f) const override { system_->force(at, f); }
  bool is_conservative() const override { return system_->is_conservative(); }
  const Damping* damping() const override { return system_->damping(); }
  const Driving* driving() const override { return system_->driving(); }
  bool is_autonomous() const override { return system_->is_autonomous(); }
  void stiffness(const At& at, SymmetricMatrix& k) const override;
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  bool stiffness_is_constant() const override { return system_->stiffness_is_constant(); }

  // The number of forces that one K costs.
  Index forces_per_stiffness() const { return 2 * static_cast<Index>(columns_of_.size()); }

 private:
  std::shared_ptr<const System> system_;
  SymmetricMatrix pattern_;
  std::vector<std::vector<Index>> columns_of_;  // of each colour
  std::vector<std::vector<Index>> rows_of_;     // of each column, above and below the diagonal
  double length_;
};

}  // namespace qddot
