#include "qddot/model/system.hpp"

#include "qddot/model/beside_force.hpp"

namespace qddot {

double System::force_beside(const At& at, MutableVec f, BesideForce& beside) const {
  beside.before(0, size());
  force(at, f);
  return beside.after(0, size());
}

const SymmetricMatrix& System::stiffness_pattern() const {
  static const SymmetricMatrix none;
  return none;
}

void System::stiffness(const At&, SymmetricMatrix&) const {
  throw std::logic_error("the system computes no stiffness matrix K");
}

}  // namespace qddot
