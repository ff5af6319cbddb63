#pragma once

#include "experiments/advice/draws.hpp"
#include "experiments/advice/hard_case.hpp"

namespace qddot::judged_advice {

// Each draws a case of its kind: the scene or the own forces, and the end time. The accuracy is
// known before.

// One mass on a spring that passes the other end closely, or goes through it.
void near_miss(HardCase& c, Draws& draw);
// The same from a great distance at a small speed, or at none.
void slow_orbit(HardCase& c, Draws& draw);
// Along the spring, through its pinned end.
void through_the_pin(HardCase& c, Draws& draw);
// Nothing happens for long: then a mass passes closely, or a pendulum falls.
void late_event(HardCase& c, Draws& draw);
// The end is a whole number of periods.
void commensurate(HardCase& c, Draws& draw);

// Two to four bodies that repel each other where they are near, and attract each other farther
// away.
void bounce(HardCase& c, Draws& draw);
// A body on an ellipse around a fixed centre, or around another body.
void planet(HardCase& c, Draws& draw);

// A net whose nodes fly apart and through each other.
void fold(HardCase& c, Draws& draw);
// Masses from 1 to 1e-8 kg.
void uneven_masses(HardCase& c, Draws& draw);
// Motions by 1e-3 to 1e-11 of what is drawn.
void small_motion(HardCase& c, Draws& draw);
// The last tenth of the time before rounding has grown to the accuracy; the whole run if it does
// not.
void before_horizon(HardCase& c, Draws& draw);
// A grid in a frame, all of it in tension, that is plucked.
void prestressed(HardCase& c, Draws& draw);
// A free net that spins, moves, and may fall.
void spinning(HardCase& c, Draws& draw);
// Two nets that do not touch, one of which moves less and faster, or not at all.
void two_parts(HardCase& c, Draws& draw);
// Another kind's motion, 10 to 1e6 m from the origin.
void far_from_zero(HardCase& c, Draws& draw);
// Some springs are 1e2 to 1e6 times as stiff as the others, and named.
void stiff(HardCase& c, Draws& draw);

// A column between two pins, or one that a spring holds from the side. It is pressed a little more
// than it can bear.
void column(HardCase& c, Draws& draw);
// The start is an equilibrium, stable or not, but for a small push or none.
void equilibrium_start(HardCase& c, Draws& draw);
// Two oscillators on a soft spring.
void weakly_coupled(HardCase& c, Draws& draw);
// Springs without stiffness at the start.
void quartic(HardCase& c, Draws& draw);
// Masses on cables of massless joints, in tension at the start.
void massless_joints(HardCase& c, Draws& draw);

}  // namespace qddot::judged_advice
