#pragma once

#include <string>
#include <vector>

#include "qddot/measure/speed/front.hpp"

namespace qddot::work_precision {

// Prints the rows as a table for people, with a warning of small stability margins.
void print_front(const std::string& scene, double until, const std::vector<FrontRow>& front,
                 const Reference& reference);

}  // namespace qddot::work_precision
