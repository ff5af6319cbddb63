#pragma once

#include <mutex>
#include <vector>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// Several systems that no force couples, joined into one: M and K are block diagonal, V is the sum.
// Integrators may run each block by itself (see System::blocks), so an evaluation of the whole may
// allocate.
//
// It has K if all blocks have K, and offers a capability if all blocks offer it. Kinks, Validity
// and PiecewiseLinear state exceptions; these and Switching it offers if any block does. It offers
// Damping if that is all that makes forces of blocks depend on velocities.
class BlockDiagonalSystem final : public CapableSystem {
 public:
  // `blocks`: in the order of their unknowns.
  explicit BlockDiagonalSystem(std::vector<std::unique_ptr<System>> blocks);

  double potential(const At& at) const override;
  bool has_potential() const override;
  void force(const At& at, MutableVec f) const override;
  bool is_conservative() const override;
  bool is_autonomous() const override;
  void stiffness(const At& at, SymmetricMatrix& k) const override;
  const SymmetricMatrix& stiffness_pattern() const override;
  bool has_stiffness() const override;
  bool bound_row_sums(const At& at, Vec& sums) const override;
  bool multiply_stiffness(const At& at, const ConstVec& x, MutableVec y) const override;
  Index stiffness_entries() const override;
  bool stiffness_is_constant() const override;

  const SplitStiffness* split_stiffness() const override;
  const DiscreteGradient* discrete_gradient() const override;
  const Laplacian* laplacian() const override;
  const PiecewiseLinear* pieces() const override;
  const Validity* validity() const override;
  const Kinks* kinks() const override;
  const Damping* damping() const override;
  std::span<const std::unique_ptr<System>> blocks() const override { return blocks_; }

  void material_stiffness(const At& at, SymmetricMatrix& k) const override;
  void weighted_stiffness(const At& at, double compression_weight,
                          SymmetricMatrix& k) const override;
  void mean_force(const At& a, const At& b, MutableVec f) const override;
  void assemble_laplacian(SymmetricMatrix& l) const override;
  bool bounds_stiffness() const override;
  bool is_linear_at(const At& at) const override;
  bool is_valid_at(const At& at) const override;
  std::optional<double> end_of_validity(const State& from, const State& to) const override;
  Index kink_count() const override;
  void kink_lengths(const At& at, MutableVec lengths) const override;
  void friction(const At& at, MutableVec f) const override;
  std::optional<double> secant_friction(const BackwardRate& rate, const ConstVec& v,
                                        MutableVec f) const override;
  void damping_matrix(const At& at, SymmetricMatrix& c) const override;
  bool damping_is_constant() const override;
  double air_damping() const override;
  bool has_dashpots() const override;
  std::optional<double> damping_time() const override;
  const Driving* driving() const override;
  Work driving_power(const At& at) const override;
  double potential_change(double from, double to, const At& at) const override;
  void force_rate(const At& at, MutableVec rate) const override;
  std::vector<Corner> corners() const override;
  const Switching* switching() const override;
  Index phase_count() const override;
  std::optional<int> order_of_slack() const override;
  void set_phases(const At& at, bool finds_slack, std::span<Phase> phases) const override;
  std::optional<Change> first_change(const State& from, const State& to,
                                     std::span<const Phase> phases,
                                     const Changed& changed) const override;
  Margin margin(const At& at, int number, Phase to) const override;
  void add_due_changes(const At& at, std::span<const Phase> phases,
                       std::vector<Change>& due) const override;
  double energy_of(const At& at, int number) const override;
  double strain_of(const At& at, int number) const override;

 private:
  // The blocks' columns follow one another in `k`, and so do their entries: evaluate(block, its
  // segment, its matrix) for each.
  template <class Evaluate>
  void assemble(const At& at, SymmetricMatrix& k, const Evaluate& evaluate) const;

  SymmetricMatrix joined_patterns() const;
  // Calls action(the block that spring `number` is in, its segment, its number there).
  template <class Action>
  auto in_block(const At& at, int number, const Action& action) const;

  std::vector<std::unique_ptr<System>> blocks_;
  // Made when somebody first asks for it, by any thread.
  mutable std::once_flag pattern_made_;
  mutable SymmetricMatrix pattern_;
};

}  // namespace qddot
