#include "qddot/analysis/damped_mode.hpp"

#include <algorithm>
#include <cmath>

namespace qddot {
namespace {

// Below this, of 2 gamma t and w t, the Taylor series loses no more than a digit.
constexpr double series_size = 1;
// The terms after which rounding is reached at that size: 1/22!.
constexpr int terms = 22;

// g = sum g_k t^k with (k + 2)(k + 1) g_{k+2} = -2 gamma (k + 1) g_{k+1} - w^2 g_k, g_2 = 1/2.
ModeResponse by_series(double gamma, double square, double t) {
  double before = 0, now = t * t / 2;  // g_{k-1} t^{k-1} and g_k t^k
  ModeResponse sum{0, 0, 0};
  for (int k = 2; k < terms; ++k) {
    sum.g += now;
    sum.s += k * now;
    sum.c += k * (k - 1) * now;
    const double next = -(2 * gamma * t * k * now + square * t * t * before) / ((k + 1) * k);
    before = now;
    now = next;
  }
  sum.s /= t;
  sum.c /= t * t;
  return sum;
}

// c and s by sines, or by rates; near critical damping by their series in d t^2.
ModeResponse by_formula(double gamma, double square, double t) {
  const double d = square - gamma * gamma, x2 = d * t * t;
  constexpr double near = 0.01;
  double c, s;
  if (std::abs(x2) < near) {
    const double decay = std::exp(-gamma * t);
    const double sine = t * (1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42 * (1 - x2 / 72))));
    const double cosine = 1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30 * (1 - x2 / 56)));
    s = decay * sine;
    c = decay * (cosine - gamma * sine);
  } else if (d > 0) {
    const double n = std::sqrt(d), decay = std::exp(-gamma * t);
    s = decay * std::sin(n * t) / n;
    c = decay * std::cos(n * t) - gamma * s;
  } else {
    const double m = std::sqrt(-d), fast = gamma + m, slow = square / fast;
    const double slowly = std::exp(-slow * t), quickly = std::exp(-fast * t);
    s = -slowly * std::expm1(-2 * m * t) / (2 * m);
    c = (fast * quickly - slow * slowly) / (2 * m);
    if (std::abs(slow) * t < series_size / 2) {  // 1 - c - 2 gamma s would cancel
      const auto decayed = [t](double rate) {
        return rate == 0 ? t : -std::expm1(-rate * t) / rate;
      };
      return {c, s, (decayed(slow) - decayed(fast)) / (2 * m)};
    }
  }
  return {c, s, (1 - c - 2 * gamma * s) / square};
}

}  // namespace

ModeResponse mode_response(double gamma, double square, double t) {
  if (t == 0) return {1, 0, 0};
  const double size = std::max(2 * std::abs(gamma) * t, std::sqrt(std::abs(square)) * t);
  return size <= series_size ? by_series(gamma, square, t) : by_formula(gamma, square, t);
}

}  // namespace qddot
