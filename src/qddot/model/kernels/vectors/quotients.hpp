#pragma once

#include "qddot/model/kernels/vector_kernels.hpp"
#include "qddot/model/kernels/vectors/lanes.hpp"

// f/m for vectors of f, as the processor's division rounds it. Division takes as long as sixteen
// products, and a step divides all forces by the masses, which never change. So y, the number
// nearest to 1/m, is made once:
//   q = f y,   q' = q - (q m - f) y,   f/m = q' - (q' m - f) y,
// with fused operations. q has a relative error of at most 2^-52, so q' is one of the two numbers
// next to f/m. Then q' m - f is exact, and the last sum is the number nearest to f/m (Markstein,
// IBM J. Research and Development 34 (1990) 111-119). A quotient of zero keeps its sign, as q m - f
// is +0 where f is a zero of either sign.
//
// Numbers on the way must be neither too small nor too large. So f is zero or in [2^-800, 2^800],
// and m in [2^-200, 2^200] (see Mass); all others are divided.
namespace qddot::kernels::QDDOT_LEVEL {
namespace {

#if QDDOT_FUSES

// Whether each number is zero or in [2^-800, 2^800).
[[gnu::always_inline]] inline bool are_moderate(Lanes f) {
  constexpr long half = 800, low = (1023l - half) << 52, span = (2 * half) << 52;
  const LaneNumbers magnitude = reinterpret_cast<LaneNumbers>(f) & __LONG_MAX__;
#ifdef __AVX512F__
  const auto bits = reinterpret_cast<__m512i>(magnitude);
  const __mmask8 is_nonzero = _mm512_test_epi64_mask(bits, bits);
  return _mm512_mask_cmpge_epu64_mask(is_nonzero, _mm512_sub_epi64(bits, _mm512_set1_epi64(low)),
                                      _mm512_set1_epi64(span)) == 0;
#else
  // Signed comparisons serve, as magnitudes are not negative.
  const LaneNumbers beyond = (magnitude < low) | (magnitude >= low + span);
  const LaneNumbers wrong = beyond & (magnitude != 0);
  return _mm256_testz_si256(reinterpret_cast<__m256i>(wrong), reinterpret_cast<__m256i>(wrong));
#endif
}

// f/m by y = 1/m.
[[gnu::always_inline]] inline Lanes quotient(Lanes f, Lanes m, Lanes y) {
  if (__builtin_expect(!are_moderate(f), 0)) return f / m;
  const Lanes q = f * y, near = subtract_product(product_less(q, m, f), y, q);
  return subtract_product(product_less(near, m, f), y, near);
}

#endif

// Calls action(quotient), where quotient(f, i) is f/m for a vector of f from place i on.
template <class Action>
[[gnu::always_inline]] inline auto with_quotients(const Masses& masses, const Action& action) {
  const double *m = masses.m, *y = masses.inverse;
#if QDDOT_FUSES
  if (y && masses.is_uniform) {
    const Lanes m0 = m[0] + Lanes{}, y0 = y[0] + Lanes{};
    return action([ m0, y0 ](Lanes f, std::ptrdiff_t)
                      __attribute__((always_inline)) { return quotient(f, m0, y0); });
  }
  if (y) {
    return action([ m, y ](Lanes f, std::ptrdiff_t i) __attribute__((always_inline)) {
      return quotient(f, load(m + i), load(y + i));
    });
  }
#else
  (void)y;
#endif
  return action([m](Lanes f, std::ptrdiff_t i)
                    __attribute__((always_inline)) { return f / load(m + i); });
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
