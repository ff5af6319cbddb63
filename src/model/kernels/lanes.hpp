#pragma once

#include <cmath>
#include <utility>

namespace qddot::kernels {

// Vectors as wide as the processor's, and how the coordinates of as many points get into them and
// out again. The compiler makes them from whatever the processor has.
constexpr int lanes = __BIGGEST_ALIGNMENT__ / sizeof(double);
using Lanes = double __attribute__((vector_size(lanes * sizeof(double)), aligned(8), may_alias));
using LaneNumbers = long __attribute__((vector_size(lanes * sizeof(long))));

inline Lanes load(const double* x) { return *reinterpret_cast<const Lanes*>(x); }
inline void store(double* x, Lanes value) { *reinterpret_cast<Lanes*>(x) = value; }

inline Lanes square_root(Lanes x) {
  for (int t = 0; t < lanes; ++t) x[t] = std::sqrt(x[t]);
  return x;
}

// The vector of number(0), number(1), ...
template <class Number>
constexpr LaneNumbers lane_numbers(const Number& number) {
  return [&]<int... t>(std::integer_sequence<int, t...>) { return LaneNumbers{number(t)...}; }
  (std::make_integer_sequence<int, lanes>());
}

// x[a][t] = q[D t + a]: coordinate a of `lanes` points that lie one after the other.
template <int D>
[[gnu::always_inline]] inline void deinterleave(const double* q, Lanes (&x)[D]) {
  static_assert(D <= 3);
  if constexpr (D == 1) {
    x[0] = load(q);
  } else {
    const Lanes first = load(q), second = load(q + lanes);
#pragma GCC unroll 3
    for (int a = 0; a < D; ++a) {
      x[a] = __builtin_shuffle(first, second, lane_numbers([a](int t) {
                                 const int e = D * t + a;
                                 return e < 2 * lanes ? e : 0;
                               }));
      if constexpr (D == 3) {
        x[a] = __builtin_shuffle(x[a], load(q + 2 * lanes), lane_numbers([a](int t) {
                                   const int e = D * t + a;
                                   return e < 2 * lanes ? t : e - lanes;
                                 }));
      }
    }
  }
}

// f[D t + a] = x[a][t] + offset[D t + a].
template <int D>
[[gnu::always_inline]] inline void interleave(const Lanes (&x)[D], const double* offset,
                                              double* f) {
  static_assert(D <= 3);
#pragma GCC unroll 3
  for (int b = 0; b < D; ++b) {
    Lanes out = x[0];
    if constexpr (D > 1) {
      out = __builtin_shuffle(x[0], x[1], lane_numbers([b](int t) {
                                const int e = b * lanes + t;
                                return e % D < 2 ? e % D * lanes + e / D : 0;
                              }));
    }
    if constexpr (D == 3) {
      out = __builtin_shuffle(out, x[2], lane_numbers([b](int t) {
                                const int e = b * lanes + t;
                                return e % D < 2 ? t : lanes + e / D;
                              }));
    }
    store(f + b * lanes, out + load(offset + b * lanes));
  }
}

// How far apart points are from which gather() gathers.
template <int D>
constexpr int point_stride = D == 1 ? 1 : 4;

// x[a][t] = points[stride j[t] + a], by whole points and not by single numbers.
template <int D>
[[gnu::always_inline]] inline void gather(const double* points, const int* j, Lanes (&x)[D]) {
  if constexpr (D == 1 || lanes < 4) {
    for (int a = 0; a < D; ++a) {
      for (int t = 0; t < lanes; ++t) x[a][t] = points[point_stride<D> * j[t] + a];
    }
  } else {
    // Points t and t + 4 side by side, then the transpose of each 4 x 4 block.
    using Point = double __attribute__((vector_size(4 * sizeof(double)), aligned(8), may_alias));
    const auto point = [&](int t) { return *reinterpret_cast<const Point*>(points + 4 * j[t]); };
    Lanes row[4];
#pragma GCC unroll 4
    for (int t = 0; t < 4; ++t) {
      if constexpr (lanes == 8) {
        row[t] = __builtin_shufflevector(point(t), point(t + 4), 0, 1, 2, 3, 4, 5, 6, 7);
      } else {
        row[t] = point(t);
      }
    }
    constexpr auto pairs = [](int first) {  // of two rows: coordinates first and first + 1
      return lane_numbers([first](int t) { return t / 4 * 4 + first + t % 4 / 2 + t % 2 * lanes; });
    };
    constexpr auto halves = [](int half) {
      return lane_numbers(
          [half](int t) { return t / 4 * 4 + 2 * half + t % 2 + t % 4 / 2 * lanes; });
    };
    const Lanes low = __builtin_shuffle(row[0], row[1], pairs(0));
    const Lanes high = __builtin_shuffle(row[2], row[3], pairs(0));
    x[0] = __builtin_shuffle(low, high, halves(0));
    x[1] = __builtin_shuffle(low, high, halves(1));
    if constexpr (D == 3) {
      x[2] = __builtin_shuffle(__builtin_shuffle(row[0], row[1], pairs(2)),
                               __builtin_shuffle(row[2], row[3], pairs(2)), halves(0));
    }
  }
}

}  // namespace qddot::kernels
