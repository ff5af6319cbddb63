#pragma once

#include "qddot/model/kernels/vectors/roots.hpp"
#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// tau/l of one slot's springs, whose squared lengths are l2; 0 where l = 0, as in spring.hpp.
template <int law_vectors, Roots roots>
[[gnu::always_inline]] inline Lanes tension_by_length(Lanes l2, const double* law, Range& range) {
  if constexpr (law_vectors == 1) {
    return load(law);
  } else {
    const auto tension = [law](Lanes l) __attribute__((always_inline)) {
      const Lanes s = l - load(law + slice_rows);
      if constexpr (law_vectors == 2) return s * load(law);
      return s * (load(law) + load(law + 2 * slice_rows) * (s * s));
    };
    if constexpr (roots == Roots::processor) {
      const Lanes l = square_root(l2), ratio = tension(l) / l;
      return l > 0 ? ratio : Lanes{};
    } else {
      range.add(l2);
      const auto [l, half_inverse] = estimated_root(l2);
      if constexpr (roots == Roots::estimated_root) return tension(l) / l;
      return estimated_quotient(tension(l), l, half_inverse);
    }
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
    const Lanes rest_length = load(law + slice_rows);
    const Lanes s = d - (d > 0 ? rest_length : -rest_length);
    Lanes force = s * stiffness;
    if constexpr (law_vectors == 3) force = s * (stiffness + load(law + 2 * slice_rows) * (s * s));
    return d != 0 ? force : Lanes{};
  }
}

// f = offset + sum of the rows of a part of a slice.
template <int D>
[[gnu::always_inline]] inline void put(const SpringTable& springs, int slice, int part,
                                       const Lanes (&sum)[D], const double* offset, double* f) {
  const int* unknowns = springs.unknowns + D * (slice * slice_rows + part * lanes);
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

// Stores a vector's rows in a ring.
[[gnu::always_inline]] inline void keep(const Ring& ring, double* rings, int row, Lanes value) {
  const int at = row & ring.mask;
  store(rings + ring.begin + at, value);
  if (at < slice_rows) store(rings + ring.begin + ring.mask + 1 + at, value);
}
// Reads the stored numbers of the rows from `row` on.
[[gnu::always_inline]] inline Lanes find(const Ring& ring, const double* rings, int row) {
  return load(rings + ring.begin + (row & ring.mask));
}

// Both ends of a spring have the same tau/l: the first end stores it, the second reads it.
template <int D, int law_vectors, Roots chosen, bool has_rings>
void sum_forces(const SpringTable& springs, const Positions& positions, double* rings,
                const double* offset, double* f, int from, int end) {
  constexpr Roots roots = D == 1 || law_vectors == 1 ? Roots::processor : chosen;
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice, row = i * lanes;
    Lanes sum[D];
    by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      for (int a = 0; a < D; ++a) sum[a] = Lanes{};
      const auto add_ratio = [&](Lanes ratio, const Lanes(&d)[D]) __attribute__((always_inline)) {
        for (int a = 0; a < D; ++a) sum[a] += ratio * d[a];
      };
      const auto add_gather = [&](int, const Lanes(&d)[D], const double* law)
          __attribute__((always_inline)) {
        if constexpr (D == 1) {
          sum[0] += force_on_line<law_vectors>(d[0], law);
        } else {
          add_ratio(tension_by_length<law_vectors, in_use>(squared_length<D>(d), law, range), d);
        }
      };
      const auto add_shift = [&](int s, int slot, const Lanes(&d)[D], const double* law)
          __attribute__((always_inline)) {
        if constexpr (!has_rings) {
          add_gather(slot, d, law);
        } else {
          const RingUse use = springs.ring_uses[s];
          const int other = row + springs.shifts[s];
          if (use.kind == RingUse::finds && other >= from * slice_rows) {
            return add_ratio(find(springs.rings[use.ring], rings, other), d);
          }
          const Lanes ratio =
              tension_by_length<law_vectors, in_use>(squared_length<D>(d), law, range);
          if (use.kind == RingUse::keeps) keep(springs.rings[use.ring], rings, row, ratio);
          add_ratio(ratio, d);
        }
      };
      for_slots<D, law_vectors>(springs, slice, part, positions, add_shift, add_gather);
    });
    put<D>(springs, slice, part, sum, offset, f);
  }
}

template <int D, int law_vectors, Roots roots>
void sum_forces(const SpringTable& springs, const Positions& positions, double* rings,
                const double* offset, double* f, int from, int end) {
  constexpr bool may_have = D > 1 && law_vectors > 1;
  if (may_have && springs.rings) {
    sum_forces<D, law_vectors, roots, may_have>(springs, positions, rings, offset, f, from, end);
  } else {
    sum_forces<D, law_vectors, roots, false>(springs, positions, rings, offset, f, from, end);
  }
}

template <int D, Roots roots>
void force(const SpringTable& springs, const Positions& positions, double* rings,
           const double* offset, double* f, int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return sum_forces<D, 1, roots>(springs, positions, rings, offset, f, from, end);
    case 2:
      return sum_forces<D, 2, roots>(springs, positions, rings, offset, f, from, end);
    default:
      return sum_forces<D, 3, roots>(springs, positions, rings, offset, f, from, end);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
