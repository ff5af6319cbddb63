#pragma once

#include <string>

#include "qddot/measure/motion/vibrating_modes.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::stability_map {

using namespace measure;

// The step that the method makes of one natural mode of a scene at rest, found by exciting it: runs
// of a few steps from small displacements and velocities along it, to both sides, projected on it.
// What differs from linear_step at the same h w is what the method makes of this scene's own forces
// (unfinished iterations, or matrices that mix modes). `rest` is at rest in scene.initial().q.
// Nonlinear solves are carried to the end. Throws as linear_step does.
LinearStep modal_step(const Method& method, const ReducedScene& rest, const Mode& mode,
                      Options options);

// In a word: blows up (grows by more than 1e-6 a step), lives (keeps half of its energy for ten
// periods and more), is killed (loses nine tenths of its amplitude within one period), is damped.
std::string modal_verdict(const LinearStep& step);

}  // namespace qddot::stability_map
