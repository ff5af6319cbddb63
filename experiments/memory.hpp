#pragma once

namespace qddot {

// What the process has allocated and not freed [bytes].
double allocated_memory();

// What the machine could still give to it without swapping [bytes]; infinite where it does not say.
double free_memory();

}  // namespace qddot
