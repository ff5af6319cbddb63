#pragma once

#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// Springs that do the same as `springs`: those without any stiffness are left out, and those
// between the same two nodes with the same rest length are one, whose stiffnesses are the sums,
// since 1/2 (k1 + k2)(l - l0)^2 + 1/4 (c1 + c2)(l - l0)^4 is the energy of both. One of
// several is stiff if any of these is: whether springs are named stiff changes nothing else. In the
// order in which each first appears.
std::vector<Spring> merged_springs(const std::vector<Spring>& springs);

}  // namespace qddot::reduce
