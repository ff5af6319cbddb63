#pragma once

#include "qddot/model/kernels/vectors/force.hpp"
#include "qddot/model/kernels/vectors/roots.hpp"
#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// l of one slot's springs, from their squared lengths or, on a line, from d.
template <int D, Roots roots>
[[gnu::always_inline]] inline Lanes length(const Lanes (&d)[D], Range& range) {
  if constexpr (D == 1) {
    return d[0] < 0 ? -d[0] : d[0];
  } else {
    const Lanes l2 = squared_length<D>(d);
    if constexpr (roots != Roots::processor) range.add(l2);
    return root_of<roots>(l2);
  }
}

// V of one slot's springs.
template <int D, int law_vectors, Roots roots>
[[gnu::always_inline]] inline Lanes spring_energy(const Lanes (&d)[D], const Law& law,
                                                  Range& range) {
  const Lanes stiffness = load(law.stiffness);
  if constexpr (law_vectors == 1) {
    return squared_length<D>(d) * (0.5 * stiffness);
  } else {
    const Lanes s = length<D, roots>(d, range) - load(law.rest_length), s2 = s * s;
    if constexpr (law_vectors == 2) return s2 * (0.5 * stiffness);
    return s2 * add_product(0.25 * load(law.quartic), s2, 0.5 * stiffness);
  }
}

template <int D, int law_vectors, Roots chosen>
void sum_energies(const SpringTable& springs, const Positions& positions, double* sums, int from,
                  int end) {
  constexpr Roots roots = D == 1 || law_vectors == 1 ? Roots::processor : chosen;
  Lanes total[parts_of_slice];
  for (int part = 0; part < parts_of_slice; ++part) total[part] = load(sums + part * lanes);
  for (int slice = from; slice < end; ++slice) {
    for (int part = 0; part < parts_of_slice; ++part) {
      Lanes own;
      by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
        own = Lanes{};
        const auto add = [&](int, const Lanes(&d)[D], const Law& law)
            __attribute__((always_inline)) {
          own += spring_energy<D, law_vectors, in_use>(d, law, range);
        };
        for_slots<D>(
            springs, slice, part, positions,
            [&](int, int slot, const Lanes(&d)[D], const Law& law)
                __attribute__((always_inline)) { add(slot, d, law); },
            add);
      });
      total[part] += own;
    }
  }
  for (int part = 0; part < parts_of_slice; ++part) store(sums + part * lanes, total[part]);
}

template <int D, Roots roots>
void energy(const SpringTable& springs, const Positions& positions, double* sums, int from,
            int end) {
  switch (springs.law_vectors) {
    case 1:
      return sum_energies<D, 1, roots>(springs, positions, sums, from, end);
    case 2:
      return sum_energies<D, 2, roots>(springs, positions, sums, from, end);
    default:
      return sum_energies<D, 3, roots>(springs, positions, sums, from, end);
  }
}

// PlainLaw::secant(a, b) over a + b; 0 if both are 0.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes secant_by_sum(Lanes a, Lanes b, const Law& law) {
  const Lanes rest_length = load(law.rest_length), s = a - rest_length, t = b - rest_length;
  Lanes stiffness = load(law.stiffness);
  if constexpr (law_vectors == 3) {
    const Lanes squares = add_product(s, s, t * t);
    stiffness = add_product(0.5 * load(law.quartic), squares, stiffness);
  }
  const Lanes sum = a + b, ratio = 0.5 * (s + t) * stiffness / sum;
  return sum > 0 ? ratio : Lanes{};
}

// f = offset + the discrete gradients of the rows' springs between two positions.
template <int D, int law_vectors, Roots chosen>
void sum_mean_forces(const SpringTable& springs, const Positions& before, const Positions& after,
                     const Offset& offset, double* f, int from, int end) {
  constexpr Roots roots = D == 1 || law_vectors == 1 ? Roots::processor : chosen;
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    Lanes sum[D];
    by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      for (int a = 0; a < D; ++a) sum[a] = Lanes{};
      for_slots_of_two<D>(
          springs, slice, part, before, after,
          [&](int, const Lanes(&d0)[D], const Lanes(&d1)[D], const Law& law)
              __attribute__((always_inline)) {
                Lanes ratio;
                if constexpr (law_vectors == 1) {
                  ratio = 0.5 * load(law.stiffness);
                } else {
                  ratio = secant_by_sum<law_vectors>(length<D, in_use>(d0, range),
                                                     length<D, in_use>(d1, range), law);
                }
                for (int a = 0; a < D; ++a) sum[a] += ratio * (d0[a] + d1[a]);
              });
    });
    put<D>(springs, slice, part, sum, offset, f);
  }
}

template <int D, Roots roots>
void mean_force(const SpringTable& springs, const Positions& before, const Positions& after,
                const Offset& offset, double* f, int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return sum_mean_forces<D, 1, roots>(springs, before, after, offset, f, from, end);
    case 2:
      return sum_mean_forces<D, 2, roots>(springs, before, after, offset, f, from, end);
    default:
      return sum_mean_forces<D, 3, roots>(springs, before, after, offset, f, from, end);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
