#include <cmath>

#include <boost/test/unit_test.hpp>

#include "experiments/convergence/observed_orders.hpp"

BOOST_AUTO_TEST_SUITE(observed_orders)

using namespace qddot;
using namespace qddot::convergence;

namespace {

// Errors C h^order at h = 2^-i, each with its floor.
std::vector<double> power(double order, double first, std::size_t count) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < count; ++i) {
    errors.push_back(first * std::exp2(-order * static_cast<double>(i)));
  }
  return errors;
}

std::vector<double> floors(std::size_t count, double floor) {
  return std::vector<double>(count, floor);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_power_of_h_has_its_order) {
  for (const double order : {1.0, 2.0, 8.0}) {
    const auto orders = qddot::convergence::observed_orders(power(order, 0.05, 4), floors(4, 0));
    BOOST_TEST(std::isnan(orders[0]));
    for (std::size_t i = 1; i < 4; ++i)
      BOOST_TEST(orders[i] == order, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(errors_in_the_noise_have_none) {
  // Order 8 from 1e-4 falls into a noise of some 1e-11, which is 7.6 from the one before, and 0.
  std::vector<double> errors = power(8, 1e-4, 3);
  errors.push_back(8e-12), errors.push_back(8e-12);
  const auto orders = qddot::convergence::observed_orders(errors, floors(5, 1e-10));
  BOOST_TEST(orders[1] == 8, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(orders[2] == 8, boost::test_tools::tolerance(1e-12));
  BOOST_TEST((std::isnan(orders[3]) && std::isnan(orders[4])));
}

BOOST_AUTO_TEST_CASE(errors_as_large_as_the_motion_have_none) {
  std::vector<double> errors = power(2, 0.8, 5);  // 0.8 0.2 0.05 0.0125 0.003
  const auto orders = qddot::convergence::observed_orders(errors, floors(5, 0));
  BOOST_TEST((std::isnan(orders[1]) && std::isnan(orders[2])));
  BOOST_TEST(orders[3] == 2, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(an_order_that_no_other_bears_out_is_none) {
  const auto orders = qddot::convergence::observed_orders({1e-2, 1e-3, 2.5e-4, 6e-5}, floors(4, 0));
  BOOST_TEST(std::isnan(orders[1]));  // 3.3
  BOOST_TEST(orders[2] == 2, boost::test_tools::tolerance(0.1));
  BOOST_TEST(orders[3] == 2, boost::test_tools::tolerance(0.1));
  // Nor one alone, nor one beside a run that failed.
  BOOST_TEST(std::isnan(qddot::convergence::observed_orders({1e-2, 1e-3}, floors(2, 0))[1]));
  const auto failed = qddot::convergence::observed_orders({1e-2, NAN, 2.5e-4, 6e-5}, floors(4, 0));
  for (const double order : failed) BOOST_TEST(std::isnan(order));
}

BOOST_AUTO_TEST_SUITE_END()
