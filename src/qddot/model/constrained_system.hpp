#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// A system with some unknowns held: their forces, and their rows and columns of K, are zero. A held
// unknown that starts at rest stays at rest. It models pinned nodes that are kept as unknowns, for
// comparison with the system that leaves them out.
//
// It has K if `system` has K, and offers the capabilities of `system`, but has no blocks.
class ConstrainedSystem final : public CapableSystem {
 public:
  // `is_held`: for each unknown of `system`.
  ConstrainedSystem(std::shared_ptr<const System> system, std::vector<bool> is_held);

  double potential(const At& at) const override { return system_->potential(at); }
  bool has_potential() const override { return system_->has_potential(); }
  void force(const At& at, MutableVec f) const override;
  bool is_conservative() const override { return system_->is_conservative(); }
  bool is_autonomous() const override { return system_->is_autonomous(); }
  void stiffness(const At& at, SymmetricMatrix& k) const override;
  const SymmetricMatrix& stiffness_pattern() const override { return system_->stiffness_pattern(); }
  bool has_stiffness() const override { return system_->has_stiffness(); }
  bool bound_row_sums(const At& at, Vec& sums) const override {
    return system_->bound_row_sums(at, sums);
  }
  bool multiply_stiffness(const At& at, const ConstVec& x, MutableVec y) const override;
  Index stiffness_entries() const override { return system_->stiffness_entries(); }
  bool stiffness_is_constant() const override { return system_->stiffness_is_constant(); }

  const SplitStiffness* split_stiffness() const override {
    return split_stiffness_ ? this : nullptr;
  }
  const DiscreteGradient* discrete_gradient() const override {
    return discrete_gradient_ ? this : nullptr;
  }
  const Laplacian* laplacian() const override { return laplacian_ ? this : nullptr; }
  const PiecewiseLinear* pieces() const override { return pieces_ ? this : nullptr; }
  const Validity* validity() const override { return validity_ ? this : nullptr; }
  const Kinks* kinks() const override { return kinks_ ? this : nullptr; }
  const Split* split() const override { return split_ ? &*split_ : nullptr; }
  const Damping* damping() const override { return damping_ ? this : nullptr; }
  const Driving* driving() const override { return driving_ ? this : nullptr; }
  const Switching* switching() const override { return switching_ ? this : nullptr; }

  void material_stiffness(const At& at, SymmetricMatrix& k) const override;
  void weighted_stiffness(const At& at, double compression_weight,
                          SymmetricMatrix& k) const override;
  void mean_force(const At& a, const At& b, MutableVec f) const override;
  void assemble_laplacian(SymmetricMatrix& l) const override;
  bool bounds_stiffness() const override { return laplacian_->bounds_stiffness(); }
  bool is_linear_at(const At& at) const override { return pieces_->is_linear_at(at); }
  bool is_valid_at(const At& at) const override { return validity_->is_valid_at(at); }
  std::optional<double> end_of_validity(const State& from, const State& to) const override {
    return validity_->end_of_validity(from, to);
  }
  Index kink_count() const override { return kinks_->kink_count(); }
  void kink_lengths(const At& at, MutableVec lengths) const override {
    kinks_->kink_lengths(at, lengths);
  }

  void friction(const At& at, MutableVec f) const override;
  std::optional<double> damped_force(const At& at, MutableVec f, MutableVec friction,
                                     BesideForce* beside) const override;
  std::optional<double> secant_friction(const BackwardRate& rate, const ConstVec& v,
                                        MutableVec f) const override;
  void damping_matrix(const At& at, SymmetricMatrix& c) const override;
  bool damping_is_constant() const override { return damping_->damping_is_constant(); }
  bool bound_damping(SymmetricMatrix& l) const override;
  double air_damping() const override { return damping_->air_damping(); }
  bool has_dashpots() const override { return damping_->has_dashpots(); }
  std::optional<double> damping_time() const override { return damping_->damping_time(); }

  Work driving_power(const At& at) const override { return driving_->driving_power(at); }
  double potential_change(double from, double to, const At& at) const override {
    return driving_->potential_change(from, to, at);
  }
  void force_rate(const At& at, MutableVec rate) const override;
  std::vector<Corner> corners() const override { return driving_->corners(); }

  Index phase_count() const override { return switching_->phase_count(); }
  std::optional<int> order_of_slack() const override { return switching_->order_of_slack(); }
  void set_phases(const At& at, bool finds_slack, std::span<Phase> phases) const override {
    switching_->set_phases(at, finds_slack, phases);
  }
  std::optional<Change> first_change(const State& from, const State& to,
                                     std::span<const Phase> phases,
                                     const Changed& changed) const override {
    return switching_->first_change(from, to, phases, changed);
  }
  Margin margin(const At& at, int number, Phase to) const override {
    return switching_->margin(at, number, to);
  }
  void add_due_changes(const At& at, std::span<const Phase> phases,
                       std::vector<Change>& due) const override {
    switching_->add_due_changes(at, phases, due);
  }
  double energy_of(const At& at, int number) const override {
    return switching_->energy_of(at, number);
  }
  double strain_of(const At& at, int number) const override {
    return switching_->strain_of(at, number);
  }

 private:
  void clear_held(SymmetricMatrix& k) const;

  std::shared_ptr<const System> system_;
  // The capabilities of the system; nullptr for a missing one.
  const SplitStiffness* split_stiffness_;
  const DiscreteGradient* discrete_gradient_;
  const Laplacian* laplacian_;
  const PiecewiseLinear* pieces_;
  const Validity* validity_;
  const Kinks* kinks_;
  const Damping* damping_;
  const Driving* driving_;
  const Switching* switching_;
  std::vector<bool> is_held_;
  std::vector<Index> unknowns_;  // the held ones
  std::optional<Split> split_;   // of the system, held likewise
  // The entries of the pattern in a row or column of a held unknown; found with the first K, by any
  // thread.
  mutable std::once_flag entries_found_;
  mutable std::vector<Index> entries_;
};

}  // namespace qddot
