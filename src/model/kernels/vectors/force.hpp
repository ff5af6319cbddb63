#pragma once

#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// tau/l of one slot's springs, whose squared lengths are l2; 0 where l = 0, as in spring.hpp.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes tension_by_length(Lanes l2, const double* law) {
  const Lanes stiffness = load(law);
  if constexpr (law_vectors == 1) {
    return stiffness;
  } else {
    const Lanes l = square_root(l2), s = l - load(law + lanes);
    Lanes tension = s * stiffness;
    if constexpr (law_vectors == 3) tension = s * (stiffness + load(law + 2 * lanes) * (s * s));
    const Lanes ratio = tension / l;
    return l > 0 ? ratio : Lanes{};
  }
}

// The force of one slot's springs on a line: there l is |d|, and neither root nor division is
// needed; 0 where d = 0, as in spring.hpp.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes force_on_line(Lanes d, const double* law) {
  const Lanes stiffness = load(law);
  if constexpr (law_vectors == 1) {
    return stiffness * d;
  } else {
    const Lanes rest_length = load(law + lanes);
    const Lanes s = d - (d > 0 ? rest_length : -rest_length);
    Lanes force = s * stiffness;
    if constexpr (law_vectors == 3) force = s * (stiffness + load(law + 2 * lanes) * (s * s));
    return d != 0 ? force : Lanes{};
  }
}

// f = offset + sum of a slice's rows.
template <int D>
[[gnu::always_inline]] inline void put(const SpringTable& springs, int slice, const Lanes (&sum)[D],
                                       const double* offset, double* f) {
  const int* unknowns = springs.unknowns + D * slice * lanes;
  const Order order = springs.orders[slice];
  if (order == Order::by_slice) return interleave<D>(sum, offset + unknowns[0], f + unknowns[0]);
  double sums[D][lanes];
  for (int a = 0; a < D; ++a) store(sums[a], sum[a]);
  for (int t = 0; t < lanes; ++t, unknowns += D) {
    for (int a = 0; a < D; ++a) {
      const int unknown = order == Order::by_row ? unknowns[0] + a : unknowns[a];
      if (unknown >= 0) f[unknown] = offset[unknown] + sums[a][t];
    }
  }
}

template <int D, int law_vectors>
void sum_forces(const SpringTable& springs, const Positions& positions, const double* offset,
                double* f, int from, int end) {
  for (int slice = from; slice < end; ++slice) {
    Lanes sum[D] = {};
    const auto add = [&](int, const Lanes(&d)[D], Lanes l2, const double* law)
        __attribute__((always_inline)) {
      if constexpr (D == 1) {
        sum[0] += force_on_line<law_vectors>(d[0], law);
      } else {
        const Lanes ratio = tension_by_length<law_vectors>(l2, law);
        for (int a = 0; a < D; ++a) sum[a] += ratio * d[a];
      }
    };
    for_slots<D, law_vectors>(springs, slice, positions, add);
    put<D>(springs, slice, sum, offset, f);
  }
}

template <int D>
void force(const SpringTable& springs, const Positions& positions, const double* offset, double* f,
           int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return sum_forces<D, 1>(springs, positions, offset, f, from, end);
    case 2:
      return sum_forces<D, 2>(springs, positions, offset, f, from, end);
    default:
      return sum_forces<D, 3>(springs, positions, offset, f, from, end);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
