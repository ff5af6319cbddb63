#pragma once

#include "qddot/scene/reduce/flight.hpp"

namespace qddot::reduce {

struct DrawnPart;

// The frame that falls with a part to which nothing is pinned. The forces of its springs add up to
// zero, so its centre of mass obeys X'' = a with a = g + sum L_i / M, L_i the loads. Let V0 be the
// mean velocity of its masses at the start, and
//   D(t) = V0 t + 1/2 a t^2,  x_i(t) = y_i(t) + D(t).
// Then y obeys m_i y_i'' = f_i(y) + L_i + m_i (g - a), with f the springs' forces, from y(0) = x(0)
// and with sum m y' = 0. Without loads that is f alone. D takes the uniform m a, and springs know
// differences of positions only. Nodes without mass weigh nothing and follow the others. With
//   V_y = V_springs(y) - sum L_i.y_i - (g - a).S,
// the energies of the nodes at x are
//   T = T(y') + P.D' + 1/2 M |D'|^2,  V = V_y - a.S - M a.D.
// P = sum m y' and S = sum m y remain because a run keeps P = 0 only to rounding. The terms of
// T + V in D alone are 1/2 M |V0|^2 at every t.
//
// Dashpots know differences of velocities only, and change nothing here. Air of alpha takes
// -alpha m (y' + D'): the centre of mass feels -alpha M D', and y feels -alpha m y'. So D is a
// Flight in air. The sum in D alone then falls by M Flight::dissipated(t).
struct Fall : Flight {
  double mass = 0;  // M [kg]; 0: there is no such frame
};

// Turns the part's velocities and gravity into those in the frame that falls with it, and stores
// that in DrawnPart::fall. Does nothing if a node is pinned, if no node has mass, or if a node
// has neither mass nor a spring.
void let_fall(DrawnPart& drawn);

// Whether the part does nothing as seen from that frame: it has no loads, all nodes are at rest and
// all springs at their rest lengths, within rounding. Then V is at its least, and T + V = V keeps
// it there for ever. Springs that pull and push in equilibrium do not count: the slightest push may
// move them.
bool rests(const DrawnPart& drawn);

}  // namespace qddot::reduce
