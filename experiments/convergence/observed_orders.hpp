#pragma once

#include <vector>

namespace qddot::convergence {

// Errors above this are no longer small beside the motion, and no power of h.
constexpr double largest_asymptotic = 0.1;
// Two observed orders of neighbouring errors may differ by this much and both be the method's.
constexpr double agreeing = 0.5;

// The orders p of errors ~ C h^p at h, h/2, h/4, ...: log2 of the error before over each error from
// the second on. An order is NaN
// - if one of its two errors is NaN, above `largest_asymptotic`, or below its floor (the
//   uncertainty by the reference and rounding),
// - if no neighbouring order of valid errors agrees within `agreeing`.
std::vector<double> observed_orders(const std::vector<double>& errors,
                                    const std::vector<double>& floors);

// The distance that rounding moves a run by: each step adds one rounding, by chance to either side.
// It is from 2^-54 to 2^-53 of a coordinate, a quarter to a half of the displacement of the
// reference's start, whose effect is `rounding_effect`.
double rounding_of_steps(double rounding_effect, double steps);

}  // namespace qddot::convergence
