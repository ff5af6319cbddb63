#pragma once

#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// Adds the sums of a part of a slice to the offset, one node after the other.
template <int D>
[[gnu::always_inline]] inline void put_by_row(const int* unknowns, const Lanes (&sum)[D],
                                              const double* offset, double* f) {
#ifdef __AVX512F__
  if constexpr (D > 1) {
    // x y of the even nodes and of the odd ones, then with z: node t and node t + 4 side by side.
    const Lanes last = D == 3 ? sum[D - 1] : Lanes{};
    const Lanes even = _mm512_unpacklo_pd(sum[0], sum[1]), odd = _mm512_unpackhi_pd(sum[0], sum[1]);
    constexpr __mmask8 own = (1 << D) - 1;
    const auto put_row = [&](int unknown, __m256d row) __attribute__((always_inline)) {
      _mm256_mask_storeu_pd(f + unknown, own, _mm256_maskz_loadu_pd(own, offset + unknown) + row);
    };
    unroll<4>([&]<int t>() __attribute__((always_inline)) {
      const Lanes rows = shuffle(t % 2 ? odd : even, last, [](int i) {
        return i % 4 < 2 ? i / 4 * 4 + t / 2 * 2 + i % 4 : lanes + i / 4 * 4 + t;
      });
      put_row(unknowns[D * t], _mm512_castpd512_pd256(rows));
      put_row(unknowns[D * (t + 4)], _mm512_extractf64x4_pd(rows, 1));
    });
    return;
  }
#endif
  double sums[D][lanes];
  for (int a = 0; a < D; ++a) store(sums[a], sum[a]);
  for (int t = 0; t < lanes; ++t) {
    const int first = unknowns[D * t];
    for (int a = 0; a < D; ++a) f[first + a] = offset[first + a] + sums[a][t];
  }
}

// f = offset + sum of the rows of a part of a slice.
template <int D>
[[gnu::always_inline]] inline void put(const SpringTable& springs, int slice, int part,
                                       const Lanes (&sum)[D], const Offset& offset, double* f) {
  const auto [order, first] = springs.slice_unknowns[slice];
  if (order == Order::by_slice) {
    const int own = first + D * part * lanes;
    return interleave<D>(sum, offset.of_slice ? offset.of_slice : offset.all + own, f + own);
  }
  const int* unknowns = springs.unknowns + D * (slice * slice_rows + part * lanes);
  if (order == Order::by_row) {
    return put_by_row<D>(unknowns, sum, offset.all, f);
  }
  double sums[D][lanes];
  for (int a = 0; a < D; ++a) store(sums[a], sum[a]);
  for (int t = 0; t < lanes; ++t, unknowns += D) {
    for (int a = 0; a < D; ++a) {
      if (unknowns[a] >= 0) f[unknowns[a]] = offset.all[unknowns[a]] + sums[a][t];
    }
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
