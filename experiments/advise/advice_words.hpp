#pragma once

#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/advice/advise.hpp"

namespace qddot::advise_program {

// Prints what the advice is based on: the frequencies of the scene and of its motion.
void print_scene(const Advices& all, const Subject& subject);
// Prints a row for each accuracy, and the commands that run the advised methods to `until` [s].
void print_advice(const Advices& all, const SceneChoice& scene, double until);

}  // namespace qddot::advise_program
