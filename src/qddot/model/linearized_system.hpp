#pragma once

#include <memory>

#include "qddot/model/system.hpp"

namespace qddot {

// The linear system that a system is about one place p, to first order in u = q - p:
//   f(q) = f(p) + K(p) u,   V(q) = V(p) - f(p).u - 1/2 u'K(p)u
// It has the same masses, blocks and air, and no other capability. `place`: n. Throws
// std::invalid_argument if the system computes no K, depends on time, has dashpots or other forces
// of velocities, constraints, or springs that go slack or break.
std::shared_ptr<const System> linearized(const System& system, const Vec& place);

// Whether linearized() accepts the system.
bool can_be_linearized(const System& system);

}  // namespace qddot
