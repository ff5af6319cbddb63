#pragma once

#include <optional>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// Springs in series through massless nodes, as one spring between the two ends.
//
// A massless node carries no force, so on both sides of it the tension tau is the same and pulls in
// opposite directions: the springs lie on one line. With tau = k_e (L_e - l_e) for each spring and
// l = sum L_e,
//   tau = k (l - l0),  1/k = sum 1/k_e,  l0 = sum l_e.
// That is exact while tau >= 0. In compression the line is an unstable equilibrium and the springs
// fold up; the one spring pushes back instead, so its law says that it holds in tension only.
// (Where l0 = 0 there is no compression.)
//
// Joints that were drawn folded, beyond an end or in another order, unfold in a plane or in space:
// with all springs on a line, L_e signed, moves d_e across it (of sum 0) change the energy by
//   1/2 tau sum d_e^2 / L_e,
// which is negative for some as soon as one L_e is, since sum L_e = l > 0. What never leaves a line
// cannot: there each choice of signs s_e has a minimum of its own,
//   tau = k (l - sum s_e l_e),  L_e = s_e l_e + tau/k_e,  wherever s_e L_e > 0 for all e with l_e >
//   0,
// and a joint goes to that of the signs it was drawn with. One joint whose signs have no minimum is
// pulled over the end that it lies beyond, to the straight one. Of several, this is not decided.
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
// without quartic term, between two ends no closer than l0 apart, where the joints end up between
// these in their order. `is_on_line`: of all nodes, whether they stay on a line with all that
// springs join them to. What becomes of the springs: `springs` loses those in series and gains the
// one for each. Massless nodes that are left are those which cannot be condensed. Like a drawn one,
// the one spring is stiff where it has more stiffness than `stiff_above`: the ends of a long series
// feel a soft spring, however stiff each.
std::vector<Series> condense_series(const std::vector<Node>& nodes, std::vector<Spring>& springs,
                                    std::optional<double> stiff_above,
                                    const std::vector<bool>& is_on_line);

}  // namespace qddot::reduce
