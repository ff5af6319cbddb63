#pragma once

#include "qddot/measure/motion/error.hpp"

namespace qddot::inline measure {

// Lets the extent of each part reach to the pins that hold its nodes: a force rounds as the ends of
// its spring do, so that a node near the origin is no more accurate than its pins. `drawn`: the
// scene that the scales are of.
void reach_to_pins(Scales& scales, const Scene& drawn);

// Whether no part moves by more than so many roundings of its extent. Such a motion is rounding
// alone, and its scales become its extents, so that errors are relative to sizes.
bool take_extents_at_rest(Scales& scales, double roundings);

}  // namespace qddot::inline measure
