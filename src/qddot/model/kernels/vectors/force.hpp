#pragma once

#include "qddot/model/kernels/vectors/force_by_rings.hpp"
#include "qddot/model/kernels/vectors/put.hpp"
#include "qddot/model/kernels/vectors/slot_sums.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// The force of one slot's springs on a line: there l is |d|, and neither root nor division is
// needed; 0 where d = 0, as in spring.hpp.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes force_on_line(Lanes d, const Law& law) {
  const Lanes stiffness = load(law.stiffness);
  if constexpr (law_vectors == 1) {
    return stiffness * d;
  } else {
    const Lanes rest_length = load(law.rest_length);
    const Lanes s = d - (d > 0 ? rest_length : -rest_length);
    Lanes force = s * stiffness;
    if constexpr (law_vectors == 3) force = s * (stiffness + load(law.quartic) * (s * s));
    return d != 0 ? force : Lanes{};
  }
}

template <int law_vectors>
void sum_forces_on_line(const SpringTable& springs, const Positions& positions,
                        const Offset& offset, double* f, int from, int end) {
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    Lanes sum[] = {Lanes{}};
    const auto add = [&](const Lanes(&d)[1], const Law& law) __attribute__((always_inline)) {
      sum[0] += force_on_line<law_vectors>(d[0], law);
    };
    for_slots<1>(
        springs, slice, part, positions,
        [&](int, int, const Lanes(&d)[1], const Law& law)
            __attribute__((always_inline)) { add(d, law); },
        [&](int, const Lanes(&d)[1], const Law& law)
            __attribute__((always_inline)) { add(d, law); });
    put<1>(springs, slice, part, sum, offset, f);
  }
}

// Every spring is computed at both of its ends.
template <int D, int law_vectors, Roots chosen>
void sum_forces_apart(const SpringTable& springs, const Positions& positions, const Offset& offset,
                      double* f, int from, int end) {
  constexpr Roots roots = law_vectors == 1 ? Roots::processor : chosen;
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    Lanes sum[D];
    by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      for (int a = 0; a < D; ++a) sum[a] = Lanes{};
      add_shifts<D, law_vectors, in_use>(springs, slice, part, positions, range, sum);
      add_gathers<D, law_vectors, in_use>(springs, slice, part, positions, range, sum);
    });
    put<D>(springs, slice, part, sum, offset, f);
  }
}

// Tables are copied: nobody else's address leads to these, so no store of a vector can change them.
template <int D, int law_vectors, Roots roots>
void sum_forces(SpringTable springs, Positions positions, double* memory, bool continues,
                Offset offset, double* f, int from, int end) {
  if constexpr (D == 1) {
    sum_forces_on_line<law_vectors>(springs, positions, offset, f, from, end);
  } else if (law_vectors > 1 && springs.rings) {
    const RingTable rings = *springs.rings;
    NoDashpots none;
    sum_forces_by_rings<D, law_vectors, roots>(springs, rings, positions, memory, continues, offset,
                                               f, from, end, none);
  } else {
    sum_forces_apart<D, law_vectors, roots>(springs, positions, offset, f, from, end);
  }
}

template <int D, Roots roots>
void force(const SpringTable& springs, const Positions& positions, double* rings, bool continues,
           const Offset& offset, double* f, int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return sum_forces<D, 1, roots>(springs, positions, rings, continues, offset, f, from, end);
    case 2:
      return sum_forces<D, 2, roots>(springs, positions, rings, continues, offset, f, from, end);
    default:
      return sum_forces<D, 3, roots>(springs, positions, rings, continues, offset, f, from, end);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
