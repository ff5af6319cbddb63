#include "qddot/model/system.hpp"

namespace qddot {

const SymmetricMatrix& System::stiffness_pattern() const {
  static const SymmetricMatrix none;
  return none;
}

void System::stiffness(const At&, SymmetricMatrix&) const {
  throw std::logic_error("the system computes no stiffness matrix K");
}

}  // namespace qddot
