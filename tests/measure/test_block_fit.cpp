#include <cmath>
#include <complex>
#include <functional>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/trend/block_covariance.hpp"
#include "qddot/measure/trend/block_fit.hpp"

BOOST_AUTO_TEST_SUITE(block_fit)

using namespace qddot;

namespace {

// The covariance of means over blocks i and j of unit length by the midpoint rule.
double by_quadrature(const std::function<double(double, double)>& covariance, Index i, Index j) {
  constexpr int points = 400;
  double sum = 0;
  for (int a = 0; a < points; ++a) {
    for (int b = 0; b < points; ++b) {
      sum += covariance(static_cast<double>(i) + (a + 0.5) / points,
                        static_cast<double>(j) + (b + 0.5) / points);
    }
  }
  return sum / (points * points);
}

// Means over 64 blocks of steps x := kept x + push by chance, each with noise.
Vec block_means(double x, double kept, double push, int steps, double noise,
                const std::function<double()>& chance) {
  Vec means = Vec::Zero(64);
  for (double& mean : means) {
    for (int k = 0; k < steps; ++k) {
      x = kept * x + push * chance();
      mean += x / steps;
    }
    if (noise > 0) mean += noise * chance();
  }
  return means;
}

}  // namespace

BOOST_AUTO_TEST_CASE(covariances_are_the_double_integrals_over_blocks) {
  // The midpoint rule is off by 1/(24 points^2) of the curvature, and by 1/(12 points) of the kink
  // on the diagonal of a square.
  const double within = 1e-4 + 1. / (12 * 400);
  const Eigen::MatrixXd walk = walk_covariance(4);
  const std::complex<double> rates[] = {{0.3, 0}, {0, -1.7}, {0.2, -0.9}, {1e-4, -2e-4}};
  for (Index i = 0; i < 4; ++i) {
    for (Index j = 0; j < 4; ++j) {
      const auto least = [](double s, double t) { return std::min(s, t); };
      BOOST_TEST(std::abs(walk(i, j) - by_quadrature(least, i, j)) < within);
      for (const auto rate : rates) {
        const auto forgets = [&](double s, double t) {
          return std::exp(-rate * std::abs(s - t)).real();
        };
        const double found = oscillation_covariance(4, rate)(i, j);
        BOOST_TEST(std::abs(found - by_quadrature(forgets, i, j)) < within);
      }
    }
  }
  // Either side of where the closed form is left for its series.
  BOOST_TEST(oscillation_covariance(4, 0.999e-3)(0, 0) == oscillation_covariance(4, 1.001e-3)(0, 0),
             boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(a_walk_has_its_size_and_no_slope) {
  constexpr int seeds = 60, steps = 100;
  int holds = 0, told = 0;
  double size = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const auto chance = [&] { return normal(random); };
    // It gains 1 a block.
    const BlockFit fit = fit_blocks(block_means(0, 1, 1 / std::sqrt(steps), steps, 0.3, chance));
    holds += fit.slope.holds(0);
    size += fit.walk / seeds;
    told += fit.colour == Colour::oscillates || fit.colour == Colour::turns;
  }
  // More than 9 of 60 intervals of 95 % miss once in 500 times. One size has an error of 9 %, their
  // mean an eighth of that.
  BOOST_TEST(holds >= seeds - 9);
  BOOST_TEST(size == 1, boost::test_tools::tolerance(0.05));
  // Once in a hundred times; more than 4 of 60 once in 2000 times.
  BOOST_TEST(told <= 4);
}

BOOST_AUTO_TEST_CASE(coloured_noise_is_told_from_a_walk_if_it_forgets_soon) {
  int soon = 0, late = 0, excluded = 0;
  constexpr unsigned seeds = 30;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const auto chance = [&] { return normal(random); };
    const auto noise = [&](double memory) {
      constexpr int steps = 50;
      const double kept = std::exp(-1 / (steps * memory));
      return fit_blocks(block_means(chance(), kept, std::sqrt(1 - kept * kept), steps, 0, chance));
    };
    const BlockFit quick = noise(1), slow = noise(16);
    soon += quick.colour == Colour::none || quick.colour == Colour::oscillates;
    late += slow.colour == Colour::undecided;
    excluded += slow.memory <= 16;
  }
  BOOST_TEST(soon > 0.8 * seeds);
  // Up to 5 % of them look like a wave or return often by chance.
  BOOST_TEST(late >= 0.8 * seeds);
  BOOST_TEST(excluded >= 0.8 * seeds);
}

BOOST_AUTO_TEST_SUITE_END()
