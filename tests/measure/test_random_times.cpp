#include <algorithm>
#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/random_times.hpp"

BOOST_AUTO_TEST_SUITE(random_times)

using namespace qddot;
using qddot::measure::random_times;  // the suite's name hides the function's

BOOST_AUTO_TEST_CASE(every_part_of_the_time_is_seen_once_and_the_end) {
  for (const std::int64_t count : {1, 2, 49, 1000}) {
    const auto times = random_times(7, count);
    BOOST_TEST_REQUIRE(std::ssize(times) == count);
    BOOST_TEST(times.back() == 7);
    for (std::int64_t i = 0; i < count; ++i) {
      // One rounding at the ends of parts.
      BOOST_TEST(times[i] >= 7. * i / count * (1 - 1e-15));
      BOOST_TEST(times[i] <= 7. * (i + 1) / count * (1 + 1e-15));
    }
    BOOST_TEST(std::ranges::is_sorted(times));
  }
  BOOST_TEST((random_times(7, 10) == random_times(7, 10)));
  BOOST_TEST((random_times(7, 10) != random_times(7, 10, 2)));
}

BOOST_AUTO_TEST_CASE(looks_at_fixed_steps_are_at_their_ends) {
  for (const double until : {10., 9.97}) {
    for (const std::int64_t count : {1, 3, 49, 500, 999, 1000, 2000}) {
      const auto times = random_step_times(0.01, until, count);
      const auto steps = static_cast<std::int64_t>(std::ceil(until / 0.01 - 1e-6));
      BOOST_TEST_REQUIRE(std::ssize(times) == std::min(count, steps));
      BOOST_TEST(times.back() == until);
      for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        BOOST_TEST(times[i] == std::round(times[i] / 0.01) * 0.01);
        BOOST_TEST(times[i] > 0);
        BOOST_TEST(times[i] < times[i + 1]);
      }
    }
  }
  BOOST_TEST(random_step_times(0.3, 1, 10).size() == 4U);  // three whole steps and a shorter one
}

// The mean of cos^2 of a vibration whose periods are all multiples of the distance of equal looks.
BOOST_AUTO_TEST_CASE(no_vibration_is_in_step_with_the_looks) {
  constexpr std::int64_t count = 1000;
  const auto mean = [](const std::vector<double>& times) {
    double sum = 0;
    for (const double t : times) sum += std::pow(std::cos(2 * M_PI * t), 2);
    return sum / count;
  };
  // The standard deviation of cos^2 is 0.35, that of the mean 0.011; the limit is four of them.
  BOOST_TEST(std::abs(mean(random_times(count, count)) - 0.5) < 0.045);
  BOOST_TEST(std::abs(mean(random_step_times(1. / 64, count, count)) - 0.5) < 0.045);
}

BOOST_AUTO_TEST_SUITE_END()
