#pragma once

#include <optional>

#include "qddot/measure/advice/lesser_answer.hpp"

namespace qddot::inline measure {

// Computes the motion of a scene as solve() does, with rods in place of springs that are much
// stiffer than the others, if that takes much longer steps and what it changes is known to leave
// the accuracy. Nothing if it is not worth a try, or if the springs have to stay.
//
// A stiff spring is a rod if it starts at its rest length and does not change it, so that it holds
// no energy; rods must not be redundant. What they change has two parts. The springs stretch by
// tau/k: that is the distance to a run of RATTLE whose rods do so without delay, g = tau/k, which
// is of order 1/k and grows with the motion. And they vibrate about that length, by tau/k at most
// at each: that adds up along a row of rods. See docs, the page on rods.
//
// Springs that start with energy are rods where damping takes it early and the accuracy is of the
// end: see change_by_vibration().
//
// `start`: the scene as its motion starts. Positions and paths only. Takes no longer than
// Wanted::seconds, but for the step at hand; an interruption gives nothing.
std::optional<LesserAnswer> solve_with_rods(const Scene& start, const Reductions& reductions,
                                            double until, const Wanted& wanted);

}  // namespace qddot::inline measure
