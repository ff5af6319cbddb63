#include <cmath>
#include <random>

#include <boost/test/unit_test.hpp>

#include "experiments/scaling/phase_table.hpp"
#include "qddot/algebra/straight_line.hpp"

BOOST_AUTO_TEST_SUITE(scaling)

using namespace qddot;
using namespace qddot::scaling;

namespace {

const std::vector<double> decades = {1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5};

std::vector<double> law(double exponent, const std::vector<double>& n) {
  std::vector<double> y;
  for (const double value : n) y.push_back(3e-8 * std::pow(value, exponent));
  return y;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_exact_power_law_is_recovered_to_rounding) {
  for (const double exponent : {0., 1., 4. / 3, 1.5, 2.}) {
    const PowerLaw fit = fit_power_law(decades, law(exponent, decades));
    // Rounding of logarithms up to 20, over a spread of four.
    BOOST_TEST(std::abs(fit.exponent - exponent) < 1e-14);
    BOOST_TEST(fit.high - fit.low < 1e-13);
  }
}

BOOST_AUTO_TEST_CASE(the_interval_covers_the_exponent_as_often_as_it_says) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.1);
  constexpr int trials = 2000;
  int covered = 0;
  for (int i = 0; i < trials; ++i) {
    std::vector<double> y = law(1.5, decades);
    for (double& value : y) value *= std::exp(noise(random));
    const PowerLaw fit = fit_power_law(decades, y);
    covered += fit.low <= 1.5 && 1.5 <= fit.high;
  }
  // 95 % of 2000, within four standard deviations of that count, sqrt(0.95 0.05 / 2000) = 0.005.
  BOOST_TEST(std::abs(static_cast<double>(covered) / trials - 0.95) < 4 * 0.005);
}

BOOST_AUTO_TEST_CASE(too_few_points_have_no_interval_and_one_has_no_exponent) {
  const PowerLaw two = fit_power_law(std::vector{1e2, 1e4}, std::vector{1., 1e3});
  BOOST_TEST(std::abs(two.exponent - 1.5) < 1e-15);
  BOOST_TEST(std::isnan(two.low));
  BOOST_TEST(std::isnan(fit_power_law(std::vector{1e2}, std::vector{1.}).exponent));
  BOOST_TEST(std::isnan(fit_power_law({}, {}).exponent));
}

BOOST_AUTO_TEST_CASE(exponents_are_those_of_the_upper_decades_beside_those_of_theory) {
  std::vector<PhaseCost> costs;
  for (const double n : {1e2, 1e3, 1e4, 1e5, 2e5}) {
    // Below 1e4 nodes something else than the law; it must not count.
    const double seconds = n < 1e4 ? 1 : 1e-9 * n * n;
    costs.push_back({"lattice", n, 13 * n, "m", "factorization", seconds, 80 * n * std::cbrt(n)});
  }
  const auto exponents = exponents_of(costs);
  BOOST_TEST_REQUIRE(exponents.size() == 2u);
  BOOST_TEST(exponents[0].phase == "factorization");
  BOOST_TEST(exponents[0].nodes_from == 1e4);
  BOOST_TEST(std::abs(exponents[0].fit.exponent - 2) < 1e-13);
  BOOST_TEST(std::abs(exponents[0].theory - 2) < 1e-13);
  BOOST_TEST(exponents[1].phase == "fill");
  BOOST_TEST(std::abs(exponents[1].fit.exponent - 4. / 3) < 1e-13);
  BOOST_TEST(std::abs(exponents[1].theory - 4. / 3) < 1e-13);
}

BOOST_AUTO_TEST_CASE(what_is_expected_grows_as_theory_has_it_from_the_last_size) {
  const std::string name = "cloth";
  const SizedScenes& cloth = find_sized_scenes(name);
  const std::vector<PhaseCost> costs = {{"cloth", 100, 500, "m", "factorization", 9, 9},
                                        {"cloth", 1e4, 5e4, "m", "factorization", 2, 1e9},
                                        {"chain", 1e6, 1e6, "m", "factorization", 5, 5}};
  const double grown = expected_seconds(costs, cloth, "m", "factorization", 4e4);
  BOOST_TEST(std::abs(grown - 2 * 8) < 1e-13);
  const double bytes = expected_bytes(costs, cloth, "m", "factorization", 1e8);
  BOOST_TEST(std::abs(bytes / 1e9 - 2e4) < 1e-10);  // n log n: 10^4 times 2
  BOOST_TEST(expected_seconds(costs, cloth, "m", "solve", 4e4) == 0);
  const std::vector<PhaseCost> iterated = {{"cloth", 1e4, 5e4, "m", "iterations", 2, 0}};
  const double iterations = expected_seconds(iterated, cloth, "m", "iterations", 4e4);
  BOOST_TEST(std::abs(iterations - 2 * 8) < 1e-13);  // four times the nodes, twice the side
}

BOOST_AUTO_TEST_SUITE_END()
