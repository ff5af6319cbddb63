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

// Coordinates first and first + 1 of two rows of four, in each half of a vector.
template <int first>
[[gnu::always_inline]] inline Lanes pairs(Lanes a, Lanes b) {
  return shuffle(a, b, [](int t) { return t / 4 * 4 + first + t % 4 / 2 + t % 2 * lanes; });
}
template <int half>
[[gnu::always_inline]] inline Lanes halves(Lanes a, Lanes b) {
  return shuffle(a, b, [](int t) { return t / 4 * 4 + 2 * half + t % 2 + t % 4 / 2 * lanes; });
}

// x[a] = coordinate a of 4 points or, of 8, points t and t + 4 side by side in row[t].
template <int D>
[[gnu::always_inline]] inline void transpose(const Lanes (&row)[4], Lanes (&x)[D]) {
  const Lanes low = pairs<0>(row[0], row[1]), high = pairs<0>(row[2], row[3]);
  x[0] = halves<0>(low, high);
  x[1] = halves<1>(low, high);
  if constexpr (D == 3) {
    x[2] = halves<0>(pairs<2>(row[0], row[1]), pairs<2>(row[2], row[3]));
  }
}

// x[a][t] = points[stride j[t] + a], by whole points and not by single numbers.
template <int D, int width = lanes>
[[gnu::always_inline]] inline void gather(const double* points, const int* j, Lanes (&x)[D]) {
  if constexpr (D == 1 || width < 4) {
    for (int a = 0; a < D; ++a) {
      for (int t = 0; t < width; ++t) x[a][t] = points[point_stride<D> * j[t] + a];
    }
  } else {
    // Points t and t + 4 side by side, then the transpose of each 4 x 4 block.
    typedef double Point __attribute__((vector_size(4 * sizeof(double)), aligned(8), may_alias));
    const auto point = [&](int t) __attribute__((always_inline)) {
      return *reinterpret_cast<const Point*>(points + point_stride<D> * j[t]);
    };
    Lanes row[4];
    unroll<4>([&]<int t>() __attribute__((always_inline)) {
      if constexpr (width == 8) {
        row[t] = __builtin_shufflevector(point(t), point(t + 4), 0, 1, 2, 3, 4, 5, 6, 7);
      } else {
        row[t] = point(t);
      }
    });
    transpose<D>(row, x);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
