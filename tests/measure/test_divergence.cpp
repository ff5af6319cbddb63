#include <boost/test/unit_test.hpp>

#include "qddot/measure/reference/divergence.hpp"

BOOST_AUTO_TEST_SUITE(divergence)

using namespace qddot;

namespace {

constexpr double rounding = 1e-16;

// A hundred times and the differences there.
struct Parting {
  std::vector<double> times, differences;

  template <class Difference>
  Parting(double until, const Difference& difference) {
    for (int i = 0; i <= 100; ++i) {
      times.push_back(until * i / 100);
      differences.push_back(difference(times.back()));
    }
  }
  Divergence found() const { return qddot::measure::divergence(times, differences); }
};

// rounding e^(rate t) up to the size of the motion.
auto exponential(double rate) {
  return [rate](double t) { return std::min(0.3, rounding * std::exp(rate * t)); };
}

double exact_horizon(double rate) { return std::log(far_apart / rounding) / rate; }

}  // namespace

BOOST_AUTO_TEST_CASE(an_exponential_is_found_to_the_next_sample) {
  for (const double rate : {5.0, 20.0, 27.0}) {
    const double until = 1.5 * exact_horizon(rate);
    const Divergence found = Parting(until, exponential(rate)).found();
    BOOST_TEST(found.horizon >= exact_horizon(rate));
    BOOST_TEST(found.horizon <= exact_horizon(rate) + until / 100);
    BOOST_TEST(found.lyapunov == rate, boost::test_tools::tolerance(1e-10));
  }
}

BOOST_AUTO_TEST_CASE(a_horizon_after_the_end_is_extrapolated) {
  const Divergence found = Parting(0.8 * exact_horizon(20), exponential(20)).found();
  BOOST_TEST(found.horizon == exact_horizon(20), boost::test_tools::tolerance(1e-10));
  BOOST_TEST(found.lyapunov == 20, boost::test_tools::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(two_looks_before_the_horizon_tell_the_rate) {
  // The last differences that are small: 1e-13 and 1e-7, a second apart.
  const Divergence found =
      qddot::measure::divergence({0, 1, 2, 3, 4, 5}, {1e-16, 1e-13, 1e-7, 0.12, 0.3, 0.3});
  BOOST_TEST(found.horizon == 3.0);
  BOOST_TEST(found.lyapunov == std::log(1e6), boost::test_tools::tolerance(1e-10));
  // And one that is small.
  const Divergence sudden = qddot::measure::divergence({0, 1, 2}, {1e-16, 0.3, 0.3});
  BOOST_TEST(sudden.horizon == 1.0);
  BOOST_TEST(sudden.lyapunov == std::log(3e15), boost::test_tools::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(an_oscillation_on_it_does_not_matter) {
  // The largest so far follows the crests; there are some in the second half.
  const auto difference = [](double t) {
    return rounding * std::exp(20 * t) * (1 + 0.9 * std::sin(60 * t));
  };
  const Divergence found = Parting(1.4, difference).found();
  BOOST_TEST(found.lyapunov == 20, boost::test_tools::tolerance(0.1));
  BOOST_TEST(found.horizon == exact_horizon(20), boost::test_tools::tolerance(0.05));
}

BOOST_AUTO_TEST_CASE(what_grows_with_time_has_no_horizon) {
  for (const double rate : {0.0, 1.0, 1e4}) {
    const Divergence found =
        Parting(10, [&](double t) { return rounding * (1 + rate * t); }).found();
    BOOST_TEST(std::isinf(found.horizon));
    BOOST_TEST(found.lyapunov == 0);
  }
}

BOOST_AUTO_TEST_CASE(what_is_apart_from_the_start_or_not_there_tells_nothing) {
  BOOST_TEST(
      std::isinf(Parting(1, [](double t) { return 0.1 * std::exp(30 * t); }).found().horizon));
  BOOST_TEST(std::isinf(qddot::measure::divergence({}, {}).horizon));
  BOOST_TEST(std::isinf(qddot::measure::divergence({0}, {rounding}).horizon));
}

BOOST_AUTO_TEST_CASE(negative_control_just_below_the_bound_of_growth_there_is_none) {
  const double until = 1;
  const auto growing = [&](double factor) {
    const double rate = std::log(factor);
    return Parting(until, [=](double t) { return rounding * std::exp(rate * t); }).found().horizon;
  };
  BOOST_TEST(std::isinf(growing(0.99 * exponential_growth)));
  BOOST_TEST(std::isfinite(growing(1.01 * exponential_growth)));
}

BOOST_AUTO_TEST_SUITE_END()
