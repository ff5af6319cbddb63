#pragma once

#include <optional>

#include "qddot/measure/advice/lesser_answer.hpp"

namespace qddot::inline measure {

// Computes a small motion of a scene as that of its natural modes about the equilibrium nearby, by
// the method `exact`, if what this changes is known to leave the accuracy. Nothing if it is not
// worth a try or the motion is not linear enough.
//
// The modes take n^3 work once for n unknowns, and no more for a longer motion. The change is
// bounded by neglected_displacement(): by the second order of the forces in closed form, and by the
// size of all else along the motion. The motion may leave the symmetry of its reductions: the rate
// at which disturbances grow is bounded in all directions (feedback_rate), and they may grow by a
// factor of e at most.
//
// `start`: the scene as its motion starts. Positions and paths only, of scenes without dashpots,
// functions of time, rods, cables and springs that break. An interruption gives nothing.
std::optional<LesserAnswer> solve_linear(const Scene& start, const Reductions& reductions,
                                         double until, const Wanted& wanted);

}  // namespace qddot::inline measure
