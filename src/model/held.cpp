#include "qddot/model/held.hpp"

namespace qddot {

Held::Held(std::shared_ptr<const System> system, std::vector<bool> is_held)
    : System(system->mass()), system_(std::move(system)) {
  Index entry = 0;
  for (Index column = 0; column < size(); ++column) {
    if (is_held[column]) unknowns_.push_back(column);
    for (SymmetricMatrix::InnerIterator at(stiffness_pattern(), column); at; ++at, ++entry) {
      if (is_held[column] || is_held[at.row()]) entries_.push_back(entry);
    }
  }
  if (const Split* split = system_->split()) {
    std::vector<bool> is_held_in_core;
    for (const Index i : split->core_unknowns) is_held_in_core.push_back(is_held[i]);
    split_ = {std::make_shared<Held>(split->stiff, is_held),
              std::make_shared<Held>(split->soft, is_held),
              std::make_shared<Held>(split->core, is_held_in_core), split->core_unknowns};
  }
}

void Held::force(const Vec& q, Vec& f) const {
  system_->force(q, f);
  for (const Index i : unknowns_) f[i] = 0;
}

void Held::mean_force(const Vec& a, const Vec& b, Vec& f) const {
  system_->mean_force(a, b, f);
  for (const Index i : unknowns_) f[i] = 0;
}

void Held::softened_stiffness(const Vec& q, double compression, SymmetricMatrix& k) const {
  system_->softened_stiffness(q, compression, k);
  clear_held(k);
}

void Held::material_stiffness(const Vec& q, SymmetricMatrix& k) const {
  system_->material_stiffness(q, k);
  clear_held(k);
}

void Held::laplacian(SymmetricMatrix& l) const {
  system_->laplacian(l);
  clear_held(l);
}

void Held::clear_held(SymmetricMatrix& k) const {
  for (const Index entry : entries_) k.valuePtr()[entry] = 0;
}

}  // namespace qddot
