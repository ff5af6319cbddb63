#include "qddot/model/constrained_system.hpp"

namespace qddot {

ConstrainedSystem::ConstrainedSystem(std::shared_ptr<const System> system,
                                     std::vector<bool> is_held)
    : CapableSystem(system->mass()),
      system_(std::move(system)),
      split_stiffness_(capability<SplitStiffness>(*system_)),
      discrete_gradient_(capability<DiscreteGradient>(*system_)),
      laplacian_(capability<Laplacian>(*system_)),
      pieces_(capability<PiecewiseLinear>(*system_)),
      validity_(capability<Validity>(*system_)),
      kinks_(capability<Kinks>(*system_)) {
  for (Index i = 0; i < size(); ++i) {
    if (is_held[i]) unknowns_.push_back(i);
  }
  Index entry = 0;
  for (Index column = 0; column < stiffness_pattern().cols(); ++column) {
    for (SymmetricMatrix::InnerIterator at(stiffness_pattern(), column); at; ++at, ++entry) {
      if (is_held[column] || is_held[at.row()]) entries_.push_back(entry);
    }
  }
  if (const Split* split = split_of(*system_)) {
    std::vector<bool> is_held_in_block;
    for (const Index i : split->stiff_unknowns) is_held_in_block.push_back(is_held[i]);
    split_ = {std::make_shared<ConstrainedSystem>(split->stiff, is_held),
              std::make_shared<ConstrainedSystem>(split->soft, is_held),
              std::make_shared<ConstrainedSystem>(split->stiff_block, is_held_in_block),
              split->stiff_unknowns};
  }
}

bool ConstrainedSystem::offers(const std::type_info& type) const {
  if (type == typeid(SplitStiffness)) return split_stiffness_;
  if (type == typeid(DiscreteGradient)) return discrete_gradient_;
  if (type == typeid(Laplacian)) return laplacian_;
  if (type == typeid(PiecewiseLinear)) return pieces_;
  if (type == typeid(Validity)) return validity_;
  if (type == typeid(Kinks)) return kinks_;
  if (type == typeid(SplitForces)) return split_.has_value();
  return true;
}

void ConstrainedSystem::force(const ConstVec& q, MutableVec f) const {
  system_->force(q, f);
  for (const Index i : unknowns_) f[i] = 0;
}

void ConstrainedSystem::discrete_gradient(const ConstVec& a, const ConstVec& b,
                                          MutableVec f) const {
  discrete_gradient_->discrete_gradient(a, b, f);
  for (const Index i : unknowns_) f[i] = 0;
}

void ConstrainedSystem::stiffness(const ConstVec& q, SymmetricMatrix& k) const {
  system_->stiffness(q, k);
  clear_held(k);
}

void ConstrainedSystem::weighted_stiffness(const ConstVec& q, double compression_weight,
                                           SymmetricMatrix& k) const {
  split_stiffness_->weighted_stiffness(q, compression_weight, k);
  clear_held(k);
}

void ConstrainedSystem::material_stiffness(const ConstVec& q, SymmetricMatrix& k) const {
  split_stiffness_->material_stiffness(q, k);
  clear_held(k);
}

void ConstrainedSystem::laplacian(SymmetricMatrix& l) const {
  laplacian_->laplacian(l);
  clear_held(l);
}

void ConstrainedSystem::clear_held(SymmetricMatrix& k) const {
  for (const Index entry : entries_) k.valuePtr()[entry] = 0;
}

}  // namespace qddot
