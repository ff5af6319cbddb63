#pragma once

#include <cstdint>
#include <vector>

namespace qddot::inline measure {

// Times [s] to look at a motion from 0 to `until`: ascending, one drawn at random from each of
// `count` parts of equal length, but `until` itself from the last. So no motion can be in step with
// the looks, as it could be with equal distances, and every part is seen. What happens during a
// fraction p of the time, anywhere, is missed with a probability of at most (1 - p)^(count - 1).
// Deterministic: other values of `seed` give other times. count >= 1, until > 0.
std::vector<double> random_times(double until, std::int64_t count, std::uint64_t seed = 1);

// The same for a run of fixed steps of h [s]: times i h, each the end of a whole step, at most
// `count` of them; all steps if there are no more. The last is `until`, the end of the last step,
// also where h does not fit. h > 0.
std::vector<double> random_step_times(double h, double until, std::int64_t count,
                                      std::uint64_t seed = 1);

}  // namespace qddot::inline measure
