#pragma once

#include <optional>
#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// A system in which some unknowns are held where they are: their forces, and the rows and columns
// of K that belong to them, are zero, as if whatever holds them always pushed back. Where such an
// unknown starts at rest it stays at rest. What remains of pinned nodes that are unknowns all the
// same, for comparison with the system that does without them.
class Held final : public System {
 public:
  // `is_held`: for each unknown of `system`.
  Held(std::shared_ptr<const System> system, std::vector<bool> is_held);

  double potential(const Vec& q) const override { return system_->potential(q); }
  void force(const Vec& q, Vec& f) const override;
  void stiffness(const Vec& q, SymmetricMatrix& k) const override { softened_stiffness(q, 1, k); }
  void softened_stiffness(const Vec& q, double compression, SymmetricMatrix& k) const override;
  void mean_force(const Vec& a, const Vec& b, Vec& f) const override;
  void material_stiffness(const Vec& q, SymmetricMatrix& k) const override;
  const SymmetricMatrix& stiffness_pattern() const override { return system_->stiffness_pattern(); }
  bool stiffness_is_constant() const override { return system_->stiffness_is_constant(); }
  bool is_linear_at(const Vec& q) const override { return system_->is_linear_at(q); }
  HasLaplacian has_laplacian() const override { return system_->has_laplacian(); }
  void laplacian(SymmetricMatrix& l) const override;
  bool holds_at(const Vec& q) const override { return system_->holds_at(q); }
  std::optional<double> stops_holding(const State& from, const State& to) const override {
    return system_->stops_holding(from, to);
  }
  const Split* split() const override { return split_ ? &*split_ : nullptr; }

 private:
  void clear_held(SymmetricMatrix& k) const;

  std::shared_ptr<const System> system_;
  std::vector<Index> unknowns_;  // the held ones
  std::vector<Index> entries_;   // of the pattern, those in a row or column of a held one
  std::optional<Split> split_;   // of the system, held likewise
};

}  // namespace qddot
