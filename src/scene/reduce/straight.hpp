#pragma once

#include <optional>

#include "qddot/model/mass_spring.hpp"

namespace qddot::reduce {

// On a line, a spring whose ends never pass through each other pulls with k (s d - l0) s, s = +-1
// being its direction and d the difference of its ends: linear in d, V = 1/2 k (d - s l0)^2. So K
// is constant for as long as no spring turns over, d = 0.
//
// The same network with a direction s for each spring, if none ever turns over from the start (q,
// v); nothing where that is not certain, or the dimension is not one, or a law is not of this kind.
// The proof is by energy, for all times. Let q* be the equilibrium of the linear system, -K (q* -
// q) = f. Its energy is that of the motion, as long as no spring has turned:
//   E - V(q*) = T + 1/2 f.(q* - q).
// A configuration in which spring e has d = 0 has at least V = V(q*) + 1/2 k_e d_e(q*)^2, since
// V - V(q*) = 1/2 (q - q*)'(-K)(q - q*) and -K >= k_e a a' with d_e = a'q + constant. So e never
// turns where E - V(q*) is less. Where nothing holds the network, -K is singular; then its centre
// of mass falls freely, and in the frame that falls with it the energy of the motion about it is at
// least 1/2 k l0^2 when a spring turns, all springs' energies being positive.
//
// That is proven for the true motion. A run whose steps are too long may leave it and turn springs
// over: forces, energies and K stay those of the laws, so that it goes on as the drawn network
// does; what takes f as linear asks first whether it is (see PiecewiseLinear).
std::optional<Network> straightened(const Network& network, const Vec& q, const Vec& v);

}  // namespace qddot::reduce
