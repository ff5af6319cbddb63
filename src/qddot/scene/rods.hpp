#pragma once

#include <string>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot {

// Whether the scene has rods (SpringLaw::rigid).
bool has_rods(const Scene& scene);

// Makes rods of all springs with more than this stiffness [N/m] that have a node which moves. Their
// rest lengths, quartic terms and all else stay behind: a rod has the spring's rest length.
void make_rods_above(double stiffness, Scene& scene);

// The stiffnesses [N/m] of the scene's springs that have a gap above them: the next larger one is
// `ratio` times as large or more. Descending. Springs of stiffness zero do not count.
std::vector<double> stiffness_gaps(const Scene& scene, double ratio);

// Throws InvalidInput, in a sentence that starts with `source` and names the rod by its nodes,
// unless
//   each rod has a node that moves, such nodes have mass, and its length is above 0;
//   at the start it has this length, and its ends do not move apart (both to rounding);
//   no rod is redundant: rods beside each other prescribe no more than nodes can do. Rods in a row,
//   drawn taut between two pins, are redundant at the start, and so is a rod of a triangulated
//   plate.
void validate_rods(const Scene& scene, const std::string& source);

}  // namespace qddot
