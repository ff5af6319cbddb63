#pragma once

#include <optional>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// Springs in series through massless nodes, as one spring between the two ends.
//
// A massless node carries no force. So the tension tau is the same on both sides of it and pulls in
// opposite directions: the springs lie on one line. Since tau = k_e (L_e - l_e) for each spring and
// l = sum L_e,
//   tau = k (l - l0),  1/k = sum 1/k_e,  l0 = sum l_e.
// This is exact while tau >= 0. If tau < 0, the line is an unstable equilibrium and the springs
// fold up, but the one spring pushes back. So its law holds in tension only. (If l0 = 0 there is no
// compression.)
//
// Joints may be drawn folded, beyond an end or in another order. They unfold in a plane or in
// space. Let all springs lie on a line, L_e signed; moves d_e across it (of sum 0) change the
// energy by
//   1/2 tau sum d_e^2 / L_e.
// This is negative for some moves as soon as one L_e is, since sum L_e = l > 0. Joints that never
// leave a line cannot unfold. There each choice of signs s_e has a minimum of its own,
//   tau = k (l - sum s_e l_e),  L_e = s_e l_e + tau/k_e,  if s_e L_e > 0 for all e with l_e > 0,
// and a joint goes to the minimum of the signs it was drawn with. If these have none, a single
// joint is pulled over the end that it lies beyond, to the straight minimum. The case of several
// joints is not decided.
struct Series {
  std::array<std::size_t, 2> ends{};
  SpringLaw law;  // of the one spring
  Holds holds = Holds::in_tension;
  bool stiff = false;
  // The massless nodes from ends[0] to ends[1]. Node j is at
  //   x_j = x_0 + shift_j n + share_j d,  d = x_1 - x_0,  n = d/l.
  struct Joint {
    std::size_t node;
    double shift;  // [m]
    double share;  // of 1
  };
  std::vector<Joint> joints;

  // Puts the joints where f = 0, with the velocities that keep them there.
  void place(std::vector<Node>& nodes) const;
};

// All series of the scene that are exact at its start. They go through massless nodes without load
// on two plain springs without quartic term. Their two ends are at least l0 apart, and the joints
// end up between these in their order. `springs` loses the springs in series and gains one for each
// series. `is_on_line`: for each node, whether its part stays on a line. Massless nodes that are
// left cannot be condensed. Like a drawn spring, the new one is stiff if it has more stiffness than
// `stiff_above`. The ends of a long series feel a soft spring, however stiff each spring is.
std::vector<Series> condense_series(const std::vector<Node>& nodes, std::vector<Spring>& springs,
                                    std::optional<double> stiff_above,
                                    const std::vector<bool>& is_on_line);

}  // namespace qddot::reduce
