// Responses of one damped mode, against the series of the equation in quadruple precision.
#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/analysis/damped_mode.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(damped_mode)

using namespace qddot;

namespace {

using Quadruple = __float128;

struct Response {
  Quadruple c, s, g;
};

// From (g, g', g'') = (0, 0, 1) in n short steps of the Taylor series, which the equation gives.
Response by_steps(double gamma, double square, double t) {
  const double size = std::max(2 * std::abs(gamma) * t, std::sqrt(std::abs(square)) * t);
  const int steps = static_cast<int>(std::ceil(4 * size)) + 1;
  const Quadruple h = Quadruple(t) / steps, two_gamma = 2 * Quadruple(gamma), w2 = square;
  Quadruple g = 0, s = 0;
  for (int i = 0; i < steps; ++i) {
    Quadruple before = g, now = s * h, sum = g + now, slope = s * h;
    // The terms of y'' = -2 gamma y' - w^2 y + 1.
    for (int k = 1; k < 30; ++k) {
      Quadruple next = -(two_gamma * h * k * now + w2 * h * h * before) / ((k + 1) * k);
      if (k == 1) next += h * h / 2;
      sum += next;
      slope += (k + 1) * next;
      before = now;
      now = next;
    }
    g = sum;
    s = slope / h;
  }
  return {1 - two_gamma * s - w2 * g, s, g};
}

}  // namespace

// A response is known to some roundings of its own size or, where it passes through zero, of what
// it is a part of: 1 for c, t for s, and less for what has decayed.
BOOST_AUTO_TEST_CASE(responses_are_right_to_rounding_for_any_damping_and_time) {
  double worst = 0;
  for (const double w : {0.0, 1e-3, 0.3, 1.0, 40.0}) {
    for (const double zeta : {0.0, 0.01, 0.5, 1 - 1e-8, 1.0, 1 + 1e-8, 1.5, 10.0, 1000.0}) {
      for (const double t : {1e-6, 1e-3, 0.1, 0.5, 1.0, 3.0, 20.0}) {
        const double gamma = w > 0 ? zeta * w : zeta;
        if (gamma * t > 2000) continue;  // the short steps would be too many
        const ModeResponse found = mode_response(gamma, w * w, t);
        const Response exact = by_steps(gamma, w * w, t);
        // A slow decay of rate r is known to eps r t.
        const double phase = 1 + w * t + std::min(gamma * t, w > 0 ? w * t / zeta : 0.0);
        const double s = static_cast<double>(exact.s), g = static_cast<double>(exact.g);
        const double error_c = static_cast<double>(std::abs(double(exact.c - found.c)));
        const double error_s = static_cast<double>(std::abs(double(exact.s - found.s)));
        const double error_g = static_cast<double>(std::abs(double(exact.g - found.g)));
        const double own_s = std::max(std::abs(s), w > 0 ? std::min(t, 1 / w) * 0.01 : 0.0);
        worst = std::max({worst, error_c / (phase * eps), error_s / (phase * eps * own_s),
                          error_g / (phase * eps * g)});
      }
    }
  }
  BOOST_TEST(worst < 64);
}

BOOST_AUTO_TEST_CASE(growing_modes_grow_as_they_should) {
  for (const double gamma : {0.0, 0.2, 3.0}) {
    for (const double t : {0.01, 0.7, 4.0}) {
      const ModeResponse found = mode_response(gamma, -2.25, t);
      const Response exact = by_steps(gamma, -2.25, t);
      BOOST_TEST(std::abs(found.c / static_cast<double>(exact.c) - 1) < 64 * eps);
      BOOST_TEST(std::abs(found.s / static_cast<double>(exact.s) - 1) < 64 * eps);
      BOOST_TEST(std::abs(found.g / static_cast<double>(exact.g) - 1) < 64 * eps);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
