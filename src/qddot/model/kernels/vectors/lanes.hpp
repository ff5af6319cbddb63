#pragma once

#include <utility>

// Whether the level has fused multiply-adds, which come with the wider vectors.
#if defined __AVX512F__ || (defined __AVX2__ && defined __FMA__)
#include <immintrin.h>
#define QDDOT_FUSES 1
#else
#define QDDOT_FUSES 0
#endif
#ifdef __aarch64__
#include <arm_neon.h>
#endif

// Sources in folders `vectors` are compiled once for each level, whose name is QDDOT_LEVEL. They
// define nothing with external linkage but a table of functions in a namespace of that name.
namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// Vectors as wide as the level's registers.
#ifdef __AVX512F__
constexpr int lanes = 8;
#elif defined __AVX__
constexpr int lanes = 4;
#else
constexpr int lanes = 2;
#endif
// A vector at any address; Clang 14 accepts the attribute on a typedef only.
typedef double Lanes __attribute__((vector_size(lanes * sizeof(double)), aligned(8), may_alias));
static_assert(alignof(Lanes) == 8);
using LaneNumbers = long __attribute__((vector_size(lanes * sizeof(long))));

[[gnu::always_inline]] inline Lanes load(const double* x) {
  return *reinterpret_cast<const Lanes*>(x);
}
[[gnu::always_inline]] inline void store(double* x, Lanes value) {
  *reinterpret_cast<Lanes*>(x) = value;
}

[[gnu::always_inline]] inline Lanes square_root(Lanes x) {
  for (int t = 0; t < lanes; ++t) x[t] = __builtin_sqrt(x[t]);
  return x;
}

// a b + c and c - a b, rounded once at levels that fuse them. The compiler also fuses sums of
// products, but it is free to choose which of two products, or none where one is used twice.
[[gnu::always_inline]] inline Lanes add_product(Lanes a, Lanes b, Lanes c) {
#ifdef __AVX512F__
  return _mm512_fmadd_pd(a, b, c);
#elif QDDOT_FUSES
  return _mm256_fmadd_pd(a, b, c);
#elif defined __aarch64__
  return reinterpret_cast<Lanes>(vfmaq_f64(reinterpret_cast<float64x2_t>(c),
                                           reinterpret_cast<float64x2_t>(a),
                                           reinterpret_cast<float64x2_t>(b)));
#else
  return a * b + c;
#endif
}
[[gnu::always_inline]] inline Lanes subtract_product(Lanes a, Lanes b, Lanes c) {
#ifdef __AVX512F__
  return _mm512_fnmadd_pd(a, b, c);
#elif QDDOT_FUSES
  return _mm256_fnmadd_pd(a, b, c);
#elif defined __aarch64__
  return reinterpret_cast<Lanes>(vfmsq_f64(reinterpret_cast<float64x2_t>(c),
                                           reinterpret_cast<float64x2_t>(a),
                                           reinterpret_cast<float64x2_t>(b)));
#else
  return c - a * b;
#endif
}
#if QDDOT_FUSES
// a b - c
[[gnu::always_inline]] inline Lanes product_less(Lanes a, Lanes b, Lanes c) {
#ifdef __AVX512F__
  return _mm512_fmsub_pd(a, b, c);
#else
  return _mm256_fmsub_pd(a, b, c);
#endif
}
#endif
[[gnu::always_inline]] inline double add_product(double a, double b, double c) {
#if QDDOT_FUSES || defined __aarch64__
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

// Calls body<0>(), body<1>(), ..., each with a constant of its own.
template <int count, class Body>
[[gnu::always_inline]] inline void unroll(const Body& body) {
  [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) {
    (body.template operator()<i>(), ...);
  }
  (std::make_integer_sequence<int, count>());
}

// The vector of number(0), number(1), ...
template <class Number>
constexpr LaneNumbers lane_numbers(const Number& number) {
  return [&]<int... t>(std::integer_sequence<int, t...>) { return LaneNumbers{number(t)...}; }
  (std::make_integer_sequence<int, lanes>());
}

// The vector of lanes number(0), number(1), ... of a and, counted on from `lanes`, b.
template <class Number>
[[gnu::always_inline]] inline Lanes shuffle(Lanes a, Lanes b, Number number) {
  return [&]<int... t>(std::integer_sequence<int, t...>) __attribute__((always_inline)) {
    return __builtin_shufflevector(a, b, number(t)...);
  }
  (std::make_integer_sequence<int, lanes>());
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
