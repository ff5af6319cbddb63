#pragma once

#include <string>
#include <vector>

#include "qddot/integrators/spring_changes.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

// Moments that are no farther apart [s] are one: springs break in symmetry, up to the rounding of
// thousands of steps. In so short a time the second one changes no motion beyond rounding.
inline double rounding_of_moment(double t) { return 4096 * machine_epsilon * t; }

// A sentence if two springs broke closer to each other than the errors of their times allow to
// tell which was first; else empty. Springs that break in one moment by symmetry are left out.
// `springs`: the scene's numbers, see Model::general_springs().
std::string unclear_order(const std::vector<Break>& breaks, const std::vector<double>& errors,
                          const std::vector<std::size_t>& springs);

}  // namespace qddot::inline measure
