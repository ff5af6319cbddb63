#pragma once

#include <string>

namespace qddot::inline kit {

// Keeps what the process frees for its next vectors, from now on. Else a large vector takes fresh
// pages, which the system clears first: that was a sixth of the time before the first step of a
// million nodes.
void keep_freed_memory();

// The memory that the process has allocated and not freed [bytes].
double allocated_memory();

// The memory [bytes] that the process can still get without swapping, within the limits of its
// address space and control group. Infinite if unknown.
double free_memory();

// A sentence that says that memory ran out, how much was in use, and how to need less.
std::string out_of_memory();

}  // namespace qddot::inline kit
