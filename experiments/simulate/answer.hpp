#pragma once

#include <string>
#include <vector>

#include "experiments/simulate/arguments.hpp"

namespace qddot::simulate {

// Finds the motion to an accuracy (--accuracy), by a method and knob of its own choice, writes what
// is asked for and says in a sentence what it did and how far it is to be trusted. Returns the
// program's status. Throws InvalidInput where something of the command line is for a method that
// the user chooses.
int answer(const CommandLine& line, Arguments& a, const std::vector<std::string>& command_line);

}  // namespace qddot::simulate
