#pragma once

#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/kernels/vectors/lanes.hpp"

// Moves the coordinates of several points, one for each lane, into vectors and back.
namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// x[a][t] = q[D t + a]: coordinate a of `lanes` points that lie one after the other.
template <int D>
[[gnu::always_inline]] inline void deinterleave(const double* q, Lanes (&x)[D]) {
  static_assert(D <= 3);
  if constexpr (D == 1) {
    x[0] = load(q);
  } else {
    const Lanes first = load(q), second = load(q + lanes);
    unroll<D>([&]<int a>() __attribute__((always_inline)) {
      x[a] = shuffle(first, second, [](int t) {
        const int e = D * t + a;
        return e < 2 * lanes ? e : 0;
      });
      if constexpr (D == 3) {
        x[a] = shuffle(x[a], load(q + 2 * lanes), [](int t) {
          const int e = D * t + a;
          return e < 2 * lanes ? t : e - lanes;
        });
      }
    });
  }
}

// f[D t + a] = x[a][t] + offset[D t + a].
template <int D>
[[gnu::always_inline]] inline void interleave(const Lanes (&x)[D], const double* offset,
                                              double* f) {
  static_assert(D <= 3);
  unroll<D>([&]<int b>() __attribute__((always_inline)) {
    Lanes out = x[0];
    if constexpr (D > 1) {
      out = shuffle(x[0], x[1], [](int t) {
        const int e = b * lanes + t;
        return e % D < 2 ? e % D * lanes + e / D : 0;
      });
    }
    if constexpr (D == 3) {
      out = shuffle(out, x[2], [](int t) {
        const int e = b * lanes + t;
        return e % D < 2 ? t : lanes + e / D;
      });
    }
    store(f + b * lanes, out + load(offset + b * lanes));
  });
}

// The numbers of even places of both, or of odd ones, by turns.
template <int odd>
[[gnu::always_inline]] inline Lanes interleaved(Lanes a, Lanes b) {
  return shuffle(a, b, [](int t) { return t / 2 * 2 + odd + t % 2 * lanes; });
}
// The even pairs of a, then those of b; or the odd pairs.
template <int odd>
[[gnu::always_inline]] inline Lanes pairs(Lanes a, Lanes b) {
  constexpr int half = lanes / 2;
  return shuffle(a, b, [](int t) { return t % half / 2 * 4 + 2 * odd + t % 2 + t / half * lanes; });
}

// The point whose numbers stand in the first four lanes of row t; in a vector of eight lanes, the
// others are of the next point but one.
constexpr int point_of_row(int t) { return lanes == 8 ? t / 2 * 4 + t % 2 : t; }

// The four numbers at `first` and, in a vector of eight lanes, at `second`.
[[gnu::always_inline]] inline Lanes load_points(const double* first, const double* second) {
#ifdef __AVX512F__
  const Lanes low = _mm512_castpd256_pd512(_mm256_loadu_pd(first));
  return _mm512_insertf64x4(low, _mm256_loadu_pd(second), 1);
#else
  (void)second;
  return load(first);
#endif
}

// x[a] = coordinate a of the points in four rows; these are three steps of the fastest shuffles.
template <int D>
[[gnu::always_inline]] inline void transpose(const Lanes (&row)[4], Lanes (&x)[D]) {
  const Lanes xz = interleaved<0>(row[0], row[1]), xz_after = interleaved<0>(row[2], row[3]);
  x[0] = pairs<0>(xz, xz_after);
  x[1] = pairs<0>(interleaved<1>(row[0], row[1]), interleaved<1>(row[2], row[3]));
  if constexpr (D == 3) x[2] = pairs<1>(xz, xz_after);
}

// x[a][t] = points[j[t] + a], by whole points and not by single numbers.
template <int D>
[[gnu::always_inline]] inline void gather(const double* points, const int* j, Lanes (&x)[D]) {
  if constexpr (D == 1 || lanes < 4) {
    for (int a = 0; a < D; ++a) {
      for (int t = 0; t < lanes; ++t) x[a][t] = points[j[t] + a];
    }
  } else {
    const auto point = [&](int t) __attribute__((always_inline)) { return points + j[t]; };
    Lanes row[4];
    unroll<4>([&]<int t>() __attribute__((always_inline)) {
      row[t] = load_points(point(point_of_row(t)), point(lanes == 8 ? point_of_row(t) + 2 : 0));
    });
    transpose<D>(row, x);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
