#pragma once

#include <string>

#include "qddot/measure/motion/vibrating_modes.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::stability_map {

// The method's step on one natural mode of a scene at rest, found by exciting the mode. It runs a
// few steps from small displacements and velocities along the mode, in both directions, and
// projects the results on it. Differences to linear_step at the same h w come from this scene's
// forces (unfinished iterations, or matrices that mix modes). `rest` is at rest in
// rest.initial().q. Nonlinear solves are carried to the end. Throws as linear_step does.
LinearStep modal_step(const Method& method, const Model& rest, const Mode& mode, Options options);

// The verdict: "blows up" grows by more than 1e-6 a step, "lives" keeps half of its energy for ten
// periods or more. "is killed" loses nine tenths of its amplitude within one period, and "is
// damped" is all else.
std::string modal_verdict(const LinearStep& step);

}  // namespace qddot::stability_map
