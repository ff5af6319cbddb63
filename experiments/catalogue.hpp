#pragma once

#include <string>

namespace qddot {

// The names of all methods, as "a, b, c".
std::string method_names();

// Prints the methods, or the scene generators with their parameters, as a table or as CSV.
void print_methods(bool as_csv);
void print_generators(bool as_csv);

}  // namespace qddot
