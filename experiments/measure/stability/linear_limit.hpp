#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::measure {

// Where h w is looked for.
constexpr double least_h_omega = 0.01, largest_h_omega = 100;

// The largest h w up to which the method, as it is, does not let q'' = -w^2 q grow: the spectral
// radius of its step is at most 1 + 1e-12, which is rounding. Found on a grid of 100 to the decade
// and, between its points, where the two roots meet at 1 or -1, since gaps of instability open
// there and may be narrow; then by bisection, to 1e-12 of it. Zero where growth fades towards h = 0
// as a power of h w does, or is there from the least h w on; infinite where nothing grows up to the
// largest.
double measured_limit(const Method& method);

}  // namespace qddot::measure
