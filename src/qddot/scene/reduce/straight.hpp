#pragma once

#include <optional>

#include "qddot/model/mass_spring.hpp"

namespace qddot::reduce {

// A spring on a line whose ends never pass through each other pulls with k (s d - l0) s. Here
// s = +-1 is its direction and d the difference of its ends. This is linear in d, V = 1/2 k
// (d - s l0)^2. So K is constant as long as no spring turns over, d = 0.
//
// Returns the network with a direction s for each spring, if none ever turns over from the start
// (q, v). Returns nothing if that is not certain, the dimension is not one, or a law is not of this
// kind. The proof is by energy, for all times. Let q* be the equilibrium of the linear system,
// -K (q* - q) = f. Its energy is that of the motion as long as no spring has turned:
//   E - V(q*) = T + 1/2 f.(q* - q).
// If spring e has d = 0, then V is at least V(q*) + 1/2 k_e d_e(q*)^2:
// V - V(q*) = 1/2 (q - q*)'(-K)(q - q*), and -K >= k_e a a' with d_e = a'q + constant. So e never
// turns if E - V(q*) is less. If nothing holds the network, -K is singular, and its centre of mass
// falls freely. The motion about it, seen from its falling frame, has at least the energy 1/2 k
// l0^2 when a spring turns, as all springs' energies are positive. That is so only without loads,
// which may pull the network apart (`is_loaded`).
//
// That is proven for the true motion. A run with too long steps may leave it and turn springs over.
// Forces, energies and K stay those of the laws, so it goes on as the drawn network does. Code that
// takes f as linear first asks whether it is (see PiecewiseLinear).
std::optional<Network> straightened(const Network& network, const Vec& q, const Vec& v,
                                    bool is_loaded);

}  // namespace qddot::reduce
