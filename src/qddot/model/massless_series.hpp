#pragma once

#include <vector>

#include "qddot/model/mass_spring.hpp"

namespace qddot {

// Springs in series through massless nodes, seen as the one spring that they are while in tension:
// 1/k = sum of 1/k_e, l0 = sum of l0_e. In compression the nodes between fold up in no time.
struct MasslessSeries {
  int i, j;               // the nodes at its ends; j < 0: `point` is the other end
  Eigen::Vector3d point;  // [m]
  SpringLaw law;
  int curve = -1;  // of the point, see Network::Anchor
};

// The series of a network. A node between has two springs and no load, and these are linear. Both
// ends have mass or are fixed. On a line, springs count that hold in tension only (see Holds).
// Springs to mirror images are left out.
std::vector<MasslessSeries> massless_series(const Network& network);

}  // namespace qddot
