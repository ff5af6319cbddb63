#pragma once

#include <optional>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// Springs that do the same as `springs`, in the order in which each first appears; nothing if
// `springs` has none to merge or to leave out. Springs without any stiffness are left out. Springs
// between the same two nodes with the same rest length become one with the sums of their
// stiffnesses. Its energy is that of both,
//   1/2 (k1 + k2)(l - l0)^2 + 1/4 (c1 + c2)(l - l0)^4.
// Springs that are not plain stay as they are. Dashpots add up likewise; one without a spring
// counts as a spring. It is stiff if any of them is; whether springs are named stiff changes
// nothing else. `nodes`: their number. In linear time if few springs begin at one node.
std::optional<std::vector<Spring>> merged_springs(const std::vector<Spring>& springs,
                                                  std::size_t nodes);

}  // namespace qddot::reduce
