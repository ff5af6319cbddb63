#include "qddot/integrators/base/hermite.hpp"

#include <array>
#include <cassert>

namespace qddot {
namespace {

// A polynomial at some point: its value and derivative there.
struct Jet {
  double value = 1, slope = 0;
};
Jet operator*(Jet a, Jet b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }
Jet operator-(Jet a, Jet b) { return {a.value - b.value, a.slope - b.slope}; }

// The polynomials of q, v and a of an instant at t.
struct Weights {
  Jet of_q{0, 0}, of_v{0, 0}, of_a{0, 0};
};
using AllWeights = std::array<Weights, most_instants>;

// Let l_i be Lagrange's polynomials, 1 at t_i and 0 at the other t_j, and s = t - t_i. Then
//   p = sum_i l_i^3 [(1 - 3 l' s + (6 l'^2 - 3/2 l'') s^2) q_i + (1 - 3 l' s) s v_i + s^2/2 a_i]
// with l' and l'' of l_i at t_i. Each bracket cancels the first two derivatives of l_i^3 there.
// The instant `without` is left out.
AllWeights all_weights(std::span<const Instant* const> instants, std::size_t without, double t) {
  assert(instants.size() >= 2 && instants.size() <= most_instants);
  AllWeights all;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    if (i == without) continue;
    const double t_i = instants[i]->state.t, s = t - t_i;
    Jet l;
    double l1 = 0, squares = 0;  // of l at t_i: l', and l'^2 - l''
    for (std::size_t j = 0; j < instants.size(); ++j) {
      if (j == i || j == without) continue;
      const double t_j = instants[j]->state.t, span = t_i - t_j;
      l = l * Jet{(t - t_j) / span, 1 / span};
      l1 += 1 / span;
      squares += 1 / (span * span);
    }
    const double l2 = l1 * l1 - squares, c2 = 6 * l1 * l1 - 1.5 * l2;
    const Jet cube = l * l * l;
    all[i] = {cube * Jet{1 - 3 * l1 * s + c2 * s * s, -3 * l1 + 2 * c2 * s},
              cube * Jet{(1 - 3 * l1 * s) * s, 1 - 6 * l1 * s}, cube * Jet{s * s / 2, s}};
  }
  return all;
}

// Adds the sums to q and v. Positions may be large beside the motion, so their differences from one
// of them are added up.
void add(std::span<const Instant* const> instants, const AllWeights& all, Vec& q, Vec& v) {
  const Vec& origin = instants.front()->state.q;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const auto& [of_q, of_v, of_a] = all[i];
    const auto& [state, a] = *instants[i];
    q += of_q.value * (state.q - origin) + of_v.value * state.v + of_a.value * a;
    v += of_q.slope * (state.q - origin) + of_v.slope * state.v + of_a.slope * a;
  }
}

constexpr std::size_t none = most_instants;

}  // namespace

void interpolate(std::span<const Instant* const> instants, double t, State& at) {
  at.t = t;
  at.q = instants.front()->state.q;
  at.v.setZero();
  add(instants, all_weights(instants, none, t), at.q, at.v);
}

void change_without(std::size_t one, std::span<const Instant* const> instants, double t, Vec& q,
                    Vec& v) {
  AllWeights all = all_weights(instants, none, t);
  const AllWeights fewer = all_weights(instants, one, t);
  for (std::size_t i = 0; i < instants.size(); ++i) {
    all[i] = {all[i].of_q - fewer[i].of_q, all[i].of_v - fewer[i].of_v,
              all[i].of_a - fewer[i].of_a};
  }
  q.setZero();
  v.setZero();
  add(instants, all, q, v);
}

}  // namespace qddot
