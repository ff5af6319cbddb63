#pragma once

#include <stdexcept>

#include "qddot/model/system.hpp"

namespace qddot {

// Throws std::invalid_argument if the system computes no K.
inline void require_stiffness(const System& system) {
  if (!system.has_stiffness()) {
    throw std::invalid_argument("the system computes no stiffness matrix K, which this is made of");
  }
}

}  // namespace qddot
