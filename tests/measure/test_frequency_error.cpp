#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/frequency_error.hpp"

BOOST_AUTO_TEST_SUITE(frequency_error)

using namespace qddot;
using measure::largest_h_omega;

namespace {

// Values are kept at steps of 2 % of h w, from below: an error of order p is off by p times that.
double slack(const Method& method) { return 0.025 * method.order; }

bool is_near(double value, double expected, double relative) {
  return std::abs(value / expected - 1) <= relative;
}

}  // namespace

BOOST_AUTO_TEST_CASE(verlet_and_the_midpoint_rule_turn_by_the_angles_of_their_formulas) {
  const Method &verlet = *find_method("verlet"), &midpoint = *find_method("implicit_midpoint");
  for (const double x : {0.01, 0.2, 1.0, 1.9}) {
    BOOST_TEST_CONTEXT("h w = " << x) {
      // Verlet: sin(w'h/2) = w h/2; the midpoint rule: tan(w'h/2) = w h/2. Near Verlet's limit the
      // angle goes as a root of what is left of it.
      const double near_limit = x > 1.5 ? 0.15 : 0;
      BOOST_TEST(is_near(measure::frequency_error(verlet, x), 2 * std::asin(x / 2) / x - 1,
                         slack(verlet) + near_limit));
      BOOST_TEST(is_near(measure::frequency_error(midpoint, x), 1 - 2 * std::atan(x / 2) / x,
                         slack(midpoint)));
    }
  }
}

BOOST_AUTO_TEST_CASE(damping_counts_as_an_error) {
  // Backward Euler multiplies a vibration by 1 / (1 - i x): its exponent is -log(1 - i x).
  const double x = 0.5;
  const std::complex<double> i(0, 1);
  const double expected = std::abs(-std::log(1.0 - i * x) / (i * x) - 1.0);
  BOOST_TEST(is_near(measure::frequency_error(*find_method("implicit_euler"), x), expected, 0.03));
}

BOOST_AUTO_TEST_CASE(beyond_the_limit_it_is_infinite) {
  for (const char* name : {"verlet", "symmetric4", "symmetric10", "rk4"}) {
    const Method& method = *find_method(name);
    const double limit = linear_limit(method);
    BOOST_TEST_CONTEXT(name) {
      BOOST_TEST(std::isfinite(measure::frequency_error(method, 0.97 * limit)));
      BOOST_TEST(std::isinf(measure::frequency_error(method, 1.01 * limit)));
      BOOST_TEST(largest_h_omega(method, 100) <= limit);
    }
  }
  BOOST_TEST(std::isinf(measure::frequency_error(*find_method("explicit_euler"), 0.1)));
  // A method that chooses its steps has no step of a vibration.
  BOOST_TEST(std::isinf(measure::frequency_error(*find_method("dprkn8"), 0.1)));
}

BOOST_AUTO_TEST_CASE(small_ones_fall_as_the_order_says) {
  for (const Method& method : methods()) {
    if (!std::isfinite(measure::frequency_error(method, 0.01)) || method.order == 0) continue;
    const double fine = measure::frequency_error(method, 0.01),
                 coarse = measure::frequency_error(method, 0.02);
    BOOST_TEST(std::abs(std::log2(coarse / fine) - method.order) < 1e-9, method.name);
  }
}

BOOST_AUTO_TEST_CASE(the_largest_step_for_an_error_is_where_it_is_that_large) {
  for (const char* name : {"verlet", "symmetric4", "symmetric8", "blanes_moan6", "trapezoidal"}) {
    const Method& method = *find_method(name);
    for (const double error : {1e-2, 1e-4, 1e-8, 1e-12}) {
      BOOST_TEST_CONTEXT(name << " " << error) {
        const double x = largest_h_omega(method, error);
        BOOST_TEST(measure::frequency_error(method, x) <= error * (1 + 1e-9));
        // A little farther it is larger, unless that is beyond the limit; two kept values lie
        // between.
        BOOST_TEST(measure::frequency_error(method, 1.05 * x) > error);
      }
    }
    BOOST_TEST(largest_h_omega(method, 0) == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
