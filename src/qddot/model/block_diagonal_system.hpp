#pragma once

#include <vector>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// Several systems that no force couples, joined into one: M and K are block diagonal, V is the sum.
// Integrators may run each block by itself (see Blocks), so an evaluation of the whole may
// allocate.
//
// It has K if all blocks have K, and offers a capability if all blocks offer it. Kinks, Validity
// and PiecewiseLinear state exceptions; these it offers if any block does.
class BlockDiagonalSystem final : public CapableSystem, public Blocks {
 public:
  // `blocks`: in the order of their unknowns.
  explicit BlockDiagonalSystem(std::vector<std::unique_ptr<System>> blocks);

  double potential(const ConstVec& q) const override;
  bool has_potential() const override;
  void force(const ConstVec& q, MutableVec f) const override;
  void stiffness(const ConstVec& q, SymmetricMatrix& k) const override;
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  bool stiffness_is_constant() const override;
  bool offers(const std::type_info& type) const override;

  void material_stiffness(const ConstVec& q, SymmetricMatrix& k) const override;
  void weighted_stiffness(const ConstVec& q, double compression_weight,
                          SymmetricMatrix& k) const override;
  void discrete_gradient(const ConstVec& a, const ConstVec& b, MutableVec f) const override;
  void laplacian(SymmetricMatrix& l) const override;
  bool bounds_stiffness() const override;
  bool is_linear_at(const ConstVec& q) const override;
  bool is_valid_at(const ConstVec& q) const override;
  std::optional<double> end_of_validity(const State& from, const State& to) const override;
  Index kinks() const override;
  void kink_lengths(const ConstVec& q, MutableVec lengths) const override;
  std::span<const std::unique_ptr<System>> blocks() const override { return blocks_; }

 private:
  // The blocks' columns follow one another in `k`, and so do their entries: evaluate(block, its
  // segment of q, its matrix) for each.
  template <class Evaluate>
  void assemble(const ConstVec& q, SymmetricMatrix& k, const Evaluate& evaluate) const;

  std::vector<std::unique_ptr<System>> blocks_;
  SymmetricMatrix pattern_;
};

}  // namespace qddot
