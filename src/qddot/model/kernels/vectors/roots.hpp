#pragma once

#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/kernels/vectors/lanes.hpp"

// The processor's root and division take many times as long as its products. Processors with
// estimates of 1/sqrt(a) and fused multiply-adds have another way to the same bits.
//
// Root. The estimate is y = 1/sqrt(a) (1 + d), |d| <= 2^-14 (AVX-512) or 1.5 2^-12. So g = a y is
// near sqrt(a), and h = y/2 is near 1/(2 sqrt(a)). Let e = 1/2 - g h; both times
//   (1 - 2e)^(-1/2) = 1 + e + 3/2 e^2 + 5/2 e^3 + 35/8 e^4 + ...
// have relative errors of at most 2.1 2^-53. One fused operation gives the rest r = a - g^2
// exactly, and g + r h differs from sqrt(a) by less than 7 2^-106 sqrt(a). Rounded it is the
// nearest number unless sqrt(a) is that near to the middle m of two. If a is in [1, 4), a - m^2 is
// an odd multiple of 2^-106. Only few a have a multiple below 28: the tests try them all.
//
// Quotient. Let s = 2h: s + s (1 - s l) is 1/l to within 12 2^-106. Rounded it is u, the number
// next to 1/l but for few l. Let l and t/l be in [1, 2) and t/l near the middle m of two numbers,
// t - m l = k 2^-105, k odd. Then p = t u is one of the two, t - p l is exact, and p + (t - p l) u
// misses t/l by less than 2^-53 l |u - 1/l|. This is less than t/l - m if l^2 |u - 1/l| < 2^-52 |k|
// (Markstein, IBM J. Research and Development 34 (1990) 111-119), which holds where u is the number
// next to 1/l. Elsewhere 1/l is near the middle of two numbers, and u is off by hardly more than
// half of their distance, 2^-54. It then holds too, except for l = 2 - 2^-52, k = 1 and t a power
// of two. There 1/l is above the middle by so little that s + s (1 - s l) must not be too small: so
// 2^-99 is added to 1 - s l.
//
// No number on the way may be too small or too large: see Range, and can_be_estimated for the laws.
namespace qddot::kernels::QDDOT_LEVEL {
namespace {

constexpr bool has_estimates = QDDOT_FUSES;

#if QDDOT_FUSES

// Whether many numbers are all in [2^-128, 2^128), or in [2^-64, 2^64) for estimates in single
// precision. The check uses their exponents.
class Range {
 public:
  void add(Lanes a) { seen_ |= reinterpret_cast<LaneNumbers>(a) - ((1023l - half) << 52); }
  bool holds() const {
#ifdef __AVX512F__
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(seen_), _mm512_set1_epi64(beyond)) == 0;
#else
    return _mm256_testz_si256(reinterpret_cast<__m256i>(seen_), _mm256_set1_epi64x(beyond));
#endif
  }

 private:
#ifdef __AVX512F__
  static constexpr long half = 128;
#else
  static constexpr long half = 64;
#endif
  static constexpr long beyond = -((2 * half) << 52);

  LaneNumbers seen_ = {};
};

// The roots of several a in the range, and about 1/(2 sqrt(a)); each operation for all of them
// before the next.
template <int count>
[[gnu::always_inline]] inline void estimated_roots(const Lanes (&a)[count], Lanes (&root)[count],
                                                   Lanes (&half_inverse)[count]) {
  const Lanes one = 1 + Lanes{};
  Lanes g[count], h[count], e[count], c[count];
  const auto for_each = [](const auto& body) __attribute__((always_inline)) {
    unroll<count>(body);
  };
  for_each([&]<int i>() __attribute__((always_inline)) {
#ifdef __AVX512F__
    h[i] = _mm512_rsqrt14_pd(a[i]);
#else
    h[i] = _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(a[i])));
#endif
  });
  for_each([&]<int i>() __attribute__((always_inline)) {
    g[i] = a[i] * h[i];
    h[i] = 0.5 * h[i];
  });
  for_each([&]<int i>()
               __attribute__((always_inline)) { e[i] = subtract_product(g[i], h[i], 0.5 * one); });
  for_each([&]<int i>() __attribute__((always_inline)) {
#ifdef __AVX512F__
    c[i] = 2.5 * one;
#else
    c[i] = add_product(e[i], 4.375 * one, 2.5 * one);
#endif
  });
  for_each([&]<int i>()
               __attribute__((always_inline)) { c[i] = add_product(e[i], c[i], 1.5 * one); });
  for_each([&]<int i>() __attribute__((always_inline)) { c[i] = add_product(e[i], c[i], one); });
  for_each([&]<int i>() __attribute__((always_inline)) { c[i] = e[i] * c[i]; });
  for_each([&]<int i>() __attribute__((always_inline)) {
    g[i] = add_product(g[i], c[i], g[i]);
    half_inverse[i] = add_product(h[i], c[i], h[i]);
  });
  for_each([&]<int i>()
               __attribute__((always_inline)) { e[i] = subtract_product(g[i], g[i], a[i]); });
  for_each([&]<int i>() __attribute__((always_inline)) {
    root[i] = add_product(e[i], half_inverse[i], g[i]);
  });
}

// t/l, given about 1/(2 l).
[[gnu::always_inline]] inline Lanes estimated_quotient(Lanes t, Lanes l, Lanes half_inverse) {
  const Lanes near_inverse = half_inverse + half_inverse;
  const Lanes rest = subtract_product(near_inverse, l, 1 + Lanes{}) + 0x1p-99;
  const Lanes inverse = add_product(near_inverse, rest, near_inverse);
  const Lanes near_quotient = t * inverse;
  return add_product(subtract_product(near_quotient, l, t), inverse, near_quotient);
}

#else

// The processor's own root takes any number.
class Range {
 public:
  void add(Lanes) {}
  bool holds() const { return true; }
};
template <int count>
[[gnu::always_inline]] inline void estimated_roots(const Lanes (&a)[count], Lanes (&root)[count],
                                                   Lanes (&)[count]) {
  for (int i = 0; i < count; ++i) root[i] = square_root(a[i]);
}
[[gnu::always_inline]] inline Lanes estimated_quotient(Lanes t, Lanes l, Lanes) { return t / l; }

#endif

// The root of a. Estimated roots need a in the range.
template <Roots roots>
[[gnu::always_inline]] inline Lanes root_of(Lanes a) {
  if constexpr (roots == Roots::processor) {
    return square_root(a);
  } else {
    const Lanes number[] = {a};
    Lanes root[1], half_inverse[1];
    estimated_roots(number, root, half_inverse);
    return root[0];
  }
}

// Calls with_roots<roots>(range). If a number was outside of the range, calls it again with the
// processor's own roots.
template <Roots roots, class WithRoots>
[[gnu::always_inline]] inline void by_roots(const WithRoots& with_roots) {
  Range range;
  with_roots.template operator()<roots>(range);
  if (roots != Roots::processor && !range.holds()) {
    with_roots.template operator()<Roots::processor>(range);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
