#pragma once

#include "qddot/model/kernels/vectors/put.hpp"
#include "qddot/model/kernels/vectors/stiffness.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// tau/l as it is.
constexpr auto whole = [](Lanes across, Lanes) __attribute__((always_inline)) { return across; };

// y = offset + K x of the rows. A spring between x_i and x_j adds B (x_j - x_i), with n = d/l
//   B w = tau/l w + (tau' - tau/l) n (n'w).
template <int D, int law_vectors, Roots chosen>
void sum_products(const SpringTable& springs, const Positions& positions, const Positions& moved,
                  const Offset& offset, double* y, int from, int end) {
  constexpr Roots roots = D == 1 || law_vectors == 1 ? Roots::processor : chosen;
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    Lanes sum[D];
    by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      for (int a = 0; a < D; ++a) sum[a] = Lanes{};
      for_slots_of_two<D>(
          springs, slice, part, positions, moved,
          [&](int, const Lanes(&d)[D], const Lanes(&w)[D], const Law& law)
              __attribute__((always_inline)) {
                const Slopes slope =
                    slopes<D, law_vectors, in_use>(squared_length<D>(d), law, whole, range);
                Lanes along = d[0] * w[0];
                for (int a = 1; a < D; ++a) along += d[a] * w[a];
                along *= (slope.along - slope.across) * slope.inverse_length * slope.inverse_length;
                for (int a = 0; a < D; ++a) sum[a] += slope.across * w[a] + along * d[a];
              });
    });
    put<D>(springs, slice, part, sum, offset, y);
  }
}

template <int D, Roots roots>
void stiffness_product(const SpringTable& springs, const Positions& positions,
                       const Positions& moved, const Offset& offset, double* y, int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return sum_products<D, 1, roots>(springs, positions, moved, offset, y, from, end);
    case 2:
      return sum_products<D, 2, roots>(springs, positions, moved, offset, y, from, end);
    default:
      return sum_products<D, 3, roots>(springs, positions, moved, offset, y, from, end);
  }
}

[[gnu::always_inline]] inline Lanes absolute(Lanes x) { return x < 0 ? -x : x; }

// Adds the sum of |B_ab| over b to sums[a].
template <int D>
[[gnu::always_inline]] inline void add_row_sums(const Lanes (&block)[triangle<D>],
                                                Lanes (&sums)[D]) {
  for (int a = 0; a < D; ++a) {
    for (int b = 0; b < D; ++b) sums[a] += absolute(block[entry<D>(a, b)]);
  }
}

// sums = offset + the sums of |K_ij| over each row i, with the blocks of fixed points too.
template <int D, int law_vectors, Roots chosen>
void sum_rows(const SpringTable& springs, const Positions& positions, const Offset& offset,
              double* sums, int from, int end) {
  constexpr Roots roots = D == 1 || law_vectors == 1 ? Roots::processor : chosen;
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    Lanes own[triangle<D>], sum[D];
    by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      for (int e = 0; e < triangle<D>; ++e) own[e] = Lanes{};
      for (int a = 0; a < D; ++a) sum[a] = Lanes{};
      const auto add = [&](int, const Lanes(&d)[D], const Law& law) __attribute__((always_inline)) {
        Lanes block[triangle<D>];
        set_blocks<D>(d, slopes<D, law_vectors, in_use>(squared_length<D>(d), law, whole, range),
                      block);
        for (int e = 0; e < triangle<D>; ++e) own[e] += block[e];
        add_row_sums<D>(block, sum);
      };
      for_slots<D>(
          springs, slice, part, positions,
          [&](int, int slot, const Lanes(&d)[D], const Law& law)
              __attribute__((always_inline)) { add(slot, d, law); },
          add);
    });
    add_row_sums<D>(own, sum);
    put<D>(springs, slice, part, sum, offset, sums);
  }
}

template <int D, Roots roots>
void stiffness_row_sums(const SpringTable& springs, const Positions& positions,
                        const Offset& offset, double* sums, int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return sum_rows<D, 1, roots>(springs, positions, offset, sums, from, end);
    case 2:
      return sum_rows<D, 2, roots>(springs, positions, offset, sums, from, end);
    default:
      return sum_rows<D, 3, roots>(springs, positions, offset, sums, from, end);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
