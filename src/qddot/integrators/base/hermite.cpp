#include "qddot/integrators/base/hermite.hpp"

#include <cassert>

namespace qddot {
namespace {

// A polynomial at some point: its value and derivative there.
struct Jet {
  double value = 1, slope = 0;
};
Jet operator*(Jet a, Jet b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }

}  // namespace

// Let l_i be Lagrange's polynomials, 1 at t_i and 0 at the other t_j, and s = t - t_i. Then
//   p = sum_i l_i^3 [(1 - 3 l' s + (6 l'^2 - 3/2 l'') s^2) q_i + (1 - 3 l' s) s v_i + s^2/2 a_i]
// with l' and l'' of l_i at t_i. Each bracket cancels the first two derivatives of l_i^3 there.
void interpolate(std::span<const Instant* const> instants, double t, State& at) {
  assert(instants.size() >= 2 && instants.size() <= most_instants);
  // Positions may be large beside the motion, so their differences from one of them are
  // interpolated.
  const Vec& origin = instants.front()->state.q;
  at.t = t;
  at.q = origin;
  at.v.setZero();
  for (const Instant* instant : instants) {
    const double t_i = instant->state.t, s = t - t_i;
    Jet l;
    double l1 = 0, squares = 0;  // of l at t_i: l', and l'^2 - l''
    for (const Instant* other : instants) {
      if (other == instant) continue;
      const double span = t_i - other->state.t;
      l = l * Jet{(t - other->state.t) / span, 1 / span};
      l1 += 1 / span;
      squares += 1 / (span * span);
    }
    const double l2 = l1 * l1 - squares, c2 = 6 * l1 * l1 - 1.5 * l2;
    const Jet cube = l * l * l;
    const Jet of_q = cube * Jet{1 - 3 * l1 * s + c2 * s * s, -3 * l1 + 2 * c2 * s};
    const Jet of_v = cube * Jet{(1 - 3 * l1 * s) * s, 1 - 6 * l1 * s};
    const Jet of_a = cube * Jet{s * s / 2, s};
    const State& state = instant->state;
    at.q += of_q.value * (state.q - origin) + of_v.value * state.v + of_a.value * instant->a;
    at.v += of_q.slope * (state.q - origin) + of_v.slope * state.v + of_a.slope * instant->a;
  }
}

}  // namespace qddot
