#include "qddot/model/constrained_system.hpp"

namespace qddot {

ConstrainedSystem::ConstrainedSystem(std::shared_ptr<const System> system,
                                     std::vector<bool> is_held)
    : CapableSystem(system->mass()),
      system_(std::move(system)),
      split_stiffness_(system_->split_stiffness()),
      discrete_gradient_(system_->discrete_gradient()),
      laplacian_(system_->laplacian()),
      pieces_(system_->pieces()),
      validity_(system_->validity()),
      kinks_(system_->kinks()),
      damping_(system_->damping()),
      driving_(system_->driving()),
      switching_(system_->switching()),
      is_held_(std::move(is_held)) {
  for (Index i = 0; i < size(); ++i) {
    if (is_held_[i]) unknowns_.push_back(i);
  }
  if (const Split* split = system_->split()) {
    std::vector<bool> is_held_in_block;
    for (const Index i : split->stiff_unknowns) is_held_in_block.push_back(is_held_[i]);
    split_ = {std::make_shared<ConstrainedSystem>(split->stiff, is_held_),
              std::make_shared<ConstrainedSystem>(split->soft, is_held_),
              std::make_shared<ConstrainedSystem>(split->stiff_block, is_held_in_block),
              split->stiff_unknowns};
  }
}

void ConstrainedSystem::force(const At& at, MutableVec f) const {
  system_->force(at, f);
  for (const Index i : unknowns_) f[i] = 0;
}

void ConstrainedSystem::mean_force(const At& a, const At& b, MutableVec f) const {
  discrete_gradient_->mean_force(a, b, f);
  for (const Index i : unknowns_) f[i] = 0;
}

void ConstrainedSystem::friction(const At& at, MutableVec f) const {
  damping_->friction(at, f);
  for (const Index i : unknowns_) f[i] = 0;
}

// Work beside it would see forces on held unknowns.
std::optional<double> ConstrainedSystem::damped_force(const At& at, MutableVec f,
                                                      MutableVec friction,
                                                      BesideForce* beside) const {
  if (beside || !damping_->damped_force(at, f, friction, nullptr)) return {};
  for (const Index i : unknowns_) f[i] = friction[i] = 0;
  return 0;
}

std::optional<double> ConstrainedSystem::secant_friction(const BackwardRate& rate,
                                                         const ConstVec& v, MutableVec f) const {
  const std::optional<double> power = damping_->secant_friction(rate, v, f);
  if (!power) return {};
  for (const Index i : unknowns_) f[i] = 0;
  return power;
}

void ConstrainedSystem::force_rate(const At& at, MutableVec rate) const {
  driving_->force_rate(at, rate);
  for (const Index i : unknowns_) rate[i] = 0;
}

void ConstrainedSystem::damping_matrix(const At& at, SymmetricMatrix& c) const {
  damping_->damping_matrix(at, c);
  clear_held(c);
}

bool ConstrainedSystem::bound_damping(SymmetricMatrix& l) const {
  if (!damping_->bound_damping(l)) return false;
  clear_held(l);
  return true;
}

bool ConstrainedSystem::multiply_stiffness(const At& at, const ConstVec& x, MutableVec y) const {
  Vec moved = x;
  for (const Index i : unknowns_) moved[i] = 0;
  if (!system_->multiply_stiffness(at, moved, y)) return false;
  for (const Index i : unknowns_) y[i] = 0;
  return true;
}

void ConstrainedSystem::stiffness(const At& at, SymmetricMatrix& k) const {
  system_->stiffness(at, k);
  clear_held(k);
}

void ConstrainedSystem::weighted_stiffness(const At& at, double compression_weight,
                                           SymmetricMatrix& k) const {
  split_stiffness_->weighted_stiffness(at, compression_weight, k);
  clear_held(k);
}

void ConstrainedSystem::material_stiffness(const At& at, SymmetricMatrix& k) const {
  split_stiffness_->material_stiffness(at, k);
  clear_held(k);
}

void ConstrainedSystem::assemble_laplacian(SymmetricMatrix& l) const {
  laplacian_->assemble_laplacian(l);
  clear_held(l);
}

void ConstrainedSystem::clear_held(SymmetricMatrix& k) const {
  std::call_once(entries_found_, [&] {
    Index entry = 0;
    for (Index column = 0; column < k.cols(); ++column) {
      for (SymmetricMatrix::InnerIterator at(k, column); at; ++at, ++entry) {
        if (is_held_[column] || is_held_[at.row()]) entries_.push_back(entry);
      }
    }
  });
  for (const Index entry : entries_) k.valuePtr()[entry] = 0;
}

}  // namespace qddot
