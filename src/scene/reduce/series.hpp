#pragma once

#include <optional>
#include <vector>

#include "src/scene/scene.hpp"

namespace qddot {

// Springs in series through massless nodes, as one spring between the two ends.
//
// A massless node carries no force, so on both sides of it the tension tau is the same and pulls in
// opposite directions: the springs lie on one line. With tau = k_e (L_e - l_e) for each spring and
// l = sum L_e,
//   tau = k (l - l0),  1/k = sum 1/k_e,  l0 = sum l_e.
// That is exact while tau >= 0. In compression the line is an unstable equilibrium and the springs
// fold up; the one spring pushes back instead, so its law says that it holds in tension only.
// (Where l0 = 0 there is no compression.)
struct Series {
  std::array<std::size_t, 2> ends{};
  SpringLaw law;  // of the one spring
  Holds holds = Holds::in_tension;
  bool stiff = false;
  // The massless nodes from ends[0] to ends[1]. With d = x_1 - x_0 and n = d/l, node j is at
  //   x_j = x_0 + shift_j n + share_j d.
  struct Joint {
    std::size_t node;
    double shift;  // [m]
    double share;  // of 1
  };
  std::vector<Joint> joints;

  // Puts the joints where f = 0 has them, and gives them the velocities that keep them there.
  void place(std::vector<Node>& nodes) const;
};

// All series of the scene that are exact at its start: through massless nodes on two springs
// without quartic term, between two ends no closer than l0 apart. What becomes of the springs:
// `springs` loses those in series and gains the one for each. Massless nodes that are left are
// those which cannot be condensed. Like a drawn one, the one spring is stiff where it has more
// stiffness than `stiff_above`: the ends of a long series feel a soft spring, however stiff each.
std::vector<Series> condense_series(const std::vector<Node>& nodes, std::vector<Spring>& springs,
                                    std::optional<double> stiff_above);

}  // namespace qddot
