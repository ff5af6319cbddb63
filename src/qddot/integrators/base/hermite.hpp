#pragma once

#include <span>

#include "qddot/model/system.hpp"

namespace qddot {

// A state and the acceleration a = M^-1 f(q) there [m/s^2].
struct Instant {
  State state;
  Vec a;
};

// The most instants that a polynomial goes through.
constexpr std::size_t most_instants = 4;

// Sets `at` to q = p(t), v = p'(t) at time t [s]. The polynomial p of degree 3m - 1 has the q, v
// and a of m instants (two to most_instants, at times that differ). The error of q is q^(3m)
// prod |t - t_i|^3 / (3m)! (Davis, Interpolation and Approximation, theorem 3.5.1).
void interpolate(std::span<const Instant* const> instants, double t, State& at);

// Sets q and v to what that polynomial changes at t if one of its m instants (three at least) is
// left out: what that instant tells of the error.
void change_without(std::size_t one, std::span<const Instant* const> instants, double t, Vec& q,
                    Vec& v);

}  // namespace qddot
