#pragma once

#include "experiments/simulate/arguments.hpp"

// Runs with their outputs. They print a sentence and return the exit status.
namespace qddot::simulate {

// Computes the motion to an accuracy (--accuracy), with a method and knob of its own choice, and
// writes the outputs. Prints a sentence on the run and its error bar.
int answer(const Arguments& a);
// Runs the method that is asked for. Warns of a doubtful knob, and explains a failure.
int run_method(const Arguments& a);

}  // namespace qddot::simulate
