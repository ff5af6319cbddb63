#pragma once

#include <functional>
#include <string>

#include "qddot/integrators/method.hpp"

namespace qddot::inline kit {

// The names of all methods, as "a, b, c".
std::string method_names();

// The names of those methods that have the given property, likewise.
std::string names_where(const std::function<bool(const Method&)>& has);

// Prints the methods, or the scene generators with their parameters, as a table or as CSV.
void print_methods(bool as_csv);
void print_generators(bool as_csv);

}  // namespace qddot::inline kit
