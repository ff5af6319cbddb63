#pragma once

#include <string>

namespace qddot::inline kit {

// The memory that the process has allocated and not freed [bytes].
double allocated_memory();

// The memory [bytes] that the process can still get without swapping, within the limits of its
// address space and control group. Infinite if unknown.
double free_memory();

// A sentence that says that memory ran out, how much was in use, and how to need less.
std::string out_of_memory();

}  // namespace qddot::inline kit
