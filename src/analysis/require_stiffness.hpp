#pragma once

#include <stdexcept>

#include "qddot/model/system.hpp"

namespace qddot {

// For what is computed from K: throws std::invalid_argument where the system computes none.
inline void require_stiffness(const System& system) {
  if (!system.has_stiffness()) {
    throw std::invalid_argument("the system computes no stiffness matrix K, which this is made of");
  }
}

}  // namespace qddot
