#pragma once

#include <vector>

namespace qddot::convergence {

// Errors above this are no longer small beside the motion, and no power of h.
constexpr double largest_asymptotic = 0.1;
// By how much two orders observed next to each other may differ where both are the method's.
constexpr double agreeing = 0.5;

// The order p of errors ~ C h^p at h, h/2, h/4, ...: log2 of the ratio of each error (from the
// second on) and the one before it. Not a number where it would say something else: where one of
// the two is no number, above `largest_asymptotic` or below its floor, which is what the reference
// and rounding leave of it; and where no order beside it, of such errors, is `agreeing`.
std::vector<double> observed_orders(const std::vector<double>& errors,
                                    const std::vector<double>& floors);

}  // namespace qddot::convergence
