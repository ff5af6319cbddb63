#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <boost/test/unit_test.hpp>
#include <fmt/format.h>

#include "experiments/digits.hpp"

using namespace qddot;

BOOST_AUTO_TEST_SUITE(digits)

namespace {

std::string written(double x) {
  char text[most_digits];
  return {text, write_digits(x, text)};
}

// How many of them are not what printf makes of the number.
template <class Numbers>
int wrong(const Numbers& numbers) {
  int count = 0;
  for (const double x : numbers) {
    char expected[most_digits];
    std::snprintf(expected, sizeof expected, "%.17g", x);
    count += written(x) != expected;
  }
  return count;
}

}  // namespace

BOOST_AUTO_TEST_CASE(numbers_of_every_size_have_the_digits_of_printf) {
  std::mt19937_64 random(1);
  std::vector<double> numbers;
  while (numbers.size() < 100'000) {
    const double any = std::bit_cast<double>(random());
    if (std::isfinite(any)) numbers.push_back(any);
    const double usual = std::ldexp(1 + std::ldexp(random() >> 12, -52), random() % 100 - 45);
    numbers.push_back(random() % 2 ? usual : -usual);
  }
  BOOST_TEST(wrong(numbers) == 0);
}

BOOST_AUTO_TEST_CASE(powers_of_ten_and_their_neighbours_do) {
  std::vector<double> numbers;
  for (int p = -30; p <= 30; ++p) {
    double below = std::pow(10.0, p), above = below;
    for (int i = 0; i < 100; ++i) {
      numbers.insert(numbers.end(), {below, above, -below});
      below = std::nextafter(below, 0);
      above = std::nextafter(above, HUGE_VAL);
    }
  }
  BOOST_TEST(wrong(numbers) == 0);
}

// Half-way cases, which are rounded to even, have few bits and a long expansion.
BOOST_AUTO_TEST_CASE(numbers_of_few_bits_do) {
  std::mt19937_64 random(2);
  std::vector<double> numbers;
  for (int e = -70; e < 60; ++e) {
    for (int bits = 1; bits < 54; ++bits) {
      for (int i = 0; i < 10; ++i) {
        numbers.push_back(std::ldexp(static_cast<double>(random() >> (64 - bits)), e));
      }
    }
  }
  BOOST_TEST(wrong(numbers) == 0);
}

BOOST_AUTO_TEST_CASE(nothing_is_longer_than_the_room_for_it) {
  using limits = std::numeric_limits<double>;
  for (const double x : {-limits::denorm_min(), -limits::max(), -limits::min(), -1.0 / 3 * 1e-4,
                         -1.0 / 3 * 1e-5, -1.0 / 3 * 1e16}) {
    BOOST_TEST(written(x).size() <= 24u);  // a sign, 17 digits, a point and an exponent
    BOOST_TEST(wrong(std::vector{x}) == 0);
  }
  BOOST_TEST(written(0.0) == "0");
  BOOST_TEST(written(-0.0) == "-0");
}

BOOST_AUTO_TEST_SUITE_END()
