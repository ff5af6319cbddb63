#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/samples.hpp"
#include "qddot/scene/invalid_input.hpp"

BOOST_AUTO_TEST_SUITE(samples)

using namespace qddot;
using Times = std::vector<double>;

namespace {

// The suite's name hides the function's.
Times multiples(double every, double until) { return qddot::measure::samples(every, until); }

}  // namespace

BOOST_AUTO_TEST_CASE(samples_are_the_multiples_up_to_the_end) {
  BOOST_TEST((multiples(0.25, 1) == Times{0, 0.25, 0.5, 0.75, 1}));
  BOOST_TEST((multiples(0.4, 1) == Times{0, 0.4, 0.8}));
  BOOST_TEST((multiples(1, 1) == Times{0, 1}));
  BOOST_TEST((multiples(3, 1) == Times{0}));
  BOOST_TEST(multiples(0, 1).empty());
}

BOOST_AUTO_TEST_CASE(samples_are_products_and_the_last_is_the_end_itself) {
  // Sums of 0.1 would part from the products at 3 x 0.1, and 3 x 0.1 > 0.3.
  for (const double every : {0.1, 0.01, 0.001, 1.0 / 3, 1e-4 / 7}) {
    for (const int count : {1, 3, 7, 10, 49, 1000}) {
      const double until = std::stod(std::to_string(count)) * every;
      for (const double end : {until, std::nextafter(until, 0.0), std::nextafter(until, 9e9)}) {
        const Times times = multiples(every, end);
        BOOST_TEST_REQUIRE(std::ssize(times) == count + 1);
        BOOST_TEST(times.back() == end);
        for (int k = 0; k < count; ++k) {
          if (times[static_cast<std::size_t>(k)] != k * every) BOOST_FAIL(every << " " << k);
        }
      }
    }
  }
  BOOST_TEST(multiples(0.1, 0.3).size() == 4u);
  BOOST_TEST(multiples(0.1, 0.3).back() == 0.3);
}

BOOST_AUTO_TEST_CASE(too_many_samples_are_refused) {
  BOOST_CHECK_THROW(multiples(1e-9, 1), InvalidInput);
  BOOST_CHECK_THROW(multiples(5e-324, 1), InvalidInput);
  BOOST_TEST(multiples(1e-5, 1).size() == 100001u);
}

BOOST_AUTO_TEST_CASE(merged_holds_each_time_after_zero_once_and_in_order) {
  using Lists = std::vector<Times>;
  const auto of = [](const Lists& lists) { return merged(lists); };
  BOOST_TEST((of({{0, 0.2, 0.4}, {0, 0.3, 0.4}}) == Times{0.2, 0.3, 0.4}));
  BOOST_TEST((of({{0, 0.2, 0.4}, {0, 0.3, 0.4}, {0, 0.1}}) == Times{0.1, 0.2, 0.3, 0.4}));
  BOOST_TEST((of({{}, {0, 1}}) == Times{1}));
  BOOST_TEST((of({{0, 1}, {}, {}}) == Times{1}));
  BOOST_TEST(of({}).empty());
  BOOST_TEST(of({{}, {}}).empty());
  BOOST_TEST(of({{0}, {0}}).empty());
}

BOOST_AUTO_TEST_CASE(times_that_only_rounding_parts_are_one) {
  const Times tenths = multiples(0.1, 3), fifths = multiples(0.2, 3), thirds = multiples(0.3, 3);
  const Times all = merged({tenths, fifths, thirds});
  BOOST_TEST(all.size() == 30u);
  BOOST_TEST(all.back() == 3);
  for (const Times& times : {tenths, fifths, thirds}) {
    std::ptrdiff_t seen = 1;  // time 0
    for (const double t : all) seen += is_sample(times, t);
    BOOST_TEST(seen == std::ssize(times));
  }
}

BOOST_AUTO_TEST_CASE(a_time_is_a_sample_or_it_is_not) {
  const Times times = multiples(0.25, 1);
  for (const double t : times) BOOST_TEST(is_sample(times, t));
  BOOST_TEST(is_sample(times, std::nextafter(0.5, 0.0)));
  BOOST_TEST(is_sample(times, std::nextafter(0.5, 1.0)));
  for (const double t : {1e-9, 0.1, 0.4999999, 0.5000001, 1.1}) BOOST_TEST(!is_sample(times, t));
  BOOST_TEST(!is_sample({}, 0));
}

BOOST_AUTO_TEST_SUITE_END()
