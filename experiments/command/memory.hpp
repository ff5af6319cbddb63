#pragma once

#include <string>

namespace qddot::command {

// What the process has allocated and not freed [bytes].
double allocated_memory();

// What the machine could still give to it without swapping [bytes], and within the limits of its
// address space and control group; infinite where nothing says.
double free_memory();

// That memory ran out, how much was in use, and what takes less; a sentence.
std::string out_of_memory();

}  // namespace qddot::command
