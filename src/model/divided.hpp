#pragma once

#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// Systems that no force couples, one after the other as one: M and K are block diagonal, V is the
// sum. What runs through time may take each part by itself (System::parts), so an evaluation of the
// whole may allocate.
class Divided final : public System {
 public:
  explicit Divided(std::vector<std::unique_ptr<System>> parts);

  double potential(const Vec& q) const override;
  void force(const Vec& q, Vec& f) const override;
  void stiffness(const Vec& q, SymmetricMatrix& k) const override { softened_stiffness(q, 1, k); }
  void softened_stiffness(const Vec& q, double compression, SymmetricMatrix& k) const override;
  void mean_force(const Vec& a, const Vec& b, Vec& f) const override;
  void material_stiffness(const Vec& q, SymmetricMatrix& k) const override;
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  bool stiffness_is_constant() const override;
  bool is_linear_at(const Vec& q) const override;
  HasLaplacian has_laplacian() const override;
  void laplacian(SymmetricMatrix& l) const override;
  bool holds_at(const Vec& q) const override;
  std::optional<double> stops_holding(const State& from, const State& to) const override;
  std::span<const std::unique_ptr<System>> parts() const override { return parts_; }

 private:
  // The parts' columns follow one another in `k`, and so do their entries: evaluate(part, its
  // segment of q, its block) for each.
  template <class Evaluate>
  void assemble(const Vec& q, SymmetricMatrix& k, const Evaluate& evaluate) const;

  std::vector<std::unique_ptr<System>> parts_;
  SymmetricMatrix pattern_;
};

}  // namespace qddot
