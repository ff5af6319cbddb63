#pragma once

#include <vector>

namespace qddot::inline measure {

// The times 0, every, 2 every, ... up to and including `until` [s]. A multiple that differs from
// `until` by rounding is `until`. Empty if every = 0. Throws InvalidInput for more than 1e8 times.
std::vector<double> samples(double every, double until);

// The times after 0 of all lists, ascending, each once.
std::vector<double> merged(const std::vector<std::vector<double>>& lists);

// Whether t is one of the times.
bool is_sample(const std::vector<double>& times, double t);

}  // namespace qddot::inline measure
