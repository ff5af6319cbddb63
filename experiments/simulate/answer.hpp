#pragma once

#include "experiments/simulate/arguments.hpp"

namespace qddot::simulate {

// Computes the motion to an accuracy (--accuracy), with a method and knob of its own choice, and
// writes the outputs. Prints a sentence on the run and its error bar. Returns the exit status.
// Throws InvalidInput if an option is for methods that the user chooses.
int answer(const Arguments& a);

}  // namespace qddot::simulate
