#pragma once

#include <Eigen/Core>

namespace qddot::reduce {

struct DrawnPart;

// The frame that falls with a part to which nothing is pinned. Its springs' forces add up to zero,
// so that its centre of mass obeys X'' = g whatever they do. With V0 the mean velocity of its
// masses at the start and
//   D(t) = V0 t + 1/2 g t^2,  x_i(t) = y_i(t) + D(t),
// y obeys M y'' = f(y), the springs' forces alone, from y(0) = x(0) and with sum m y' = 0: gravity
// is uniform, so that m g is what D takes, and springs know differences of positions only. Nodes
// without mass weigh nothing and follow the others. Energies are those of the nodes at x:
//   T = T(y') + P.D' + 1/2 M |D'|^2,  V = V_springs(y) - g.S - M g.D,
// P = sum m y' and S = sum m y, which is what remains of the sums where a run has kept P = 0 only
// to rounding. In T + V the terms in D alone are 1/2 M |V0|^2 at every t.
struct Fall {
  double mass = 0;                                     // M [kg]; 0: there is no such frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // V0 [m/s]
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();   // g [m/s^2]

  bool moves() const { return !velocity.isZero(0) || !gravity.isZero(0); }
  Eigen::Vector3d displacement(double t) const { return t * velocity + (0.5 * t * t) * gravity; }
  Eigen::Vector3d velocity_at(double t) const { return velocity + t * gravity; }
};

// Turns the part's velocities and gravity into those in the frame that falls with it, and leaves
// that in DrawnPart::fall; nothing where some node is pinned, none has mass, or one is on no spring
// and without mass, so that nothing decides its motion.
void let_fall(DrawnPart& drawn);

// Whether the part, as seen from that frame, does nothing: all nodes are at rest and all springs at
// their rest lengths, within rounding. Then V is at its least, and T + V = V keeps it there for
// ever. An equilibrium of springs that pull and push is not taken for rest: the slightest push may
// move it.
bool rests(const DrawnPart& drawn);

}  // namespace qddot::reduce
