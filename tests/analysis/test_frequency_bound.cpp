#include <boost/test/unit_test.hpp>

#include "qddot/analysis/largest_frequency.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(frequency_bound)

using namespace qddot;

namespace {

// The name of the suite hides that of the function.
double bound_at(const System& system, const Vec& q) { return qddot::frequency_bound(system, q); }

// A row sum of |K| is at most 2 sum |B|_inf over the springs of its node, |B|_inf <= sqrt(D) |B|_2;
// while w_max^2 >= trace(-K_ii) / (D m_i) >= sum |B|_2 / (D m_i) where every B is positive
// semidefinite. So bound^2 / w_max^2 <= 2 D sqrt(D).
double largest_ratio(int dimension) { return std::sqrt(2 * dimension * std::sqrt(dimension)); }

// Samples of random networks with all springs stretched or compressed.
template <class Check>
void for_random_networks(double stretch, const Check& check) {
  std::mt19937 random(7);
  for (const int dimension : {1, 2, 3}) {
    for (const int nodes : {1, 2, 5, 9}) {
      const Problem p = random_network(random, dimension, nodes, stretch);
      const auto system = make_mass_spring(p.network);
      const double largest = std::sqrt(squared_frequencies(*system, p.initial.q).maxCoeff());
      check(dimension, bound_at(*system, p.initial.q), largest);
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(bound_is_never_below_the_largest_frequency) {
  for (const double stretch : {1.5, 1.0, 0.6}) {
    for_random_networks(stretch, [](int, double bound, double largest) {
      BOOST_TEST(bound >= largest * (1 - 20 * eps));  // equal in 1D, but for the eigensolver
    });
  }
}

BOOST_AUTO_TEST_CASE(bound_of_stretched_networks_is_near_the_largest_frequency) {
  for_random_networks(1.5, [](int dimension, double bound, double largest) {
    BOOST_TEST(bound <= largest * largest_ratio(dimension));
  });
}

BOOST_AUTO_TEST_CASE(bound_is_the_frequency_of_oscillator_and_equal_pair) {
  const Oscillator o;
  const auto [network, initial] = o.problem();
  BOOST_TEST(std::abs(bound_at(*make_mass_spring(network), initial.q) - o.omega()) <
             4 * eps * o.omega());
  // Two free masses of 2 kg on 36 N/m: w^2 = k (1/m + 1/m) = 36, and a row of |K| sums up to 2 k.
  const auto pair = make_mass_spring(
      {.dimension = 1, .node_mass = Vec{{2, 2}}, .links = {{0, 1, {.stiffness = 36}}}});
  BOOST_TEST(std::abs(bound_at(*pair, Vec{{0, 1}}) - 6) < 6 * 4 * eps);
}

BOOST_AUTO_TEST_CASE(bound_is_taken_where_it_is_asked_for) {
  // w^2 = 3 c x^2 / m of a quartic spring without rest length and stiffness.
  const auto system = make_mass_spring(
      {.dimension = 1, .node_mass = Vec::Ones(1), .anchors = {{0, {0, 0, 0}, {.quartic = 3}}}});
  BOOST_TEST(bound_at(*system, Vec::Constant(1, 0)) == 0);
  BOOST_TEST(std::abs(bound_at(*system, Vec::Constant(1, 2)) - 6) < 6 * 4 * eps);
}

BOOST_AUTO_TEST_CASE(massless_node_makes_it_infinite_only_with_stiffness) {
  const auto bound = [](const SpringLaw& law) {
    const auto system = make_mass_spring({.dimension = 1,
                                          .node_mass = Vec{{0, 1, 1}},
                                          .links = {{0, 1, law}, {1, 2, {.stiffness = 2}}}});
    return bound_at(*system, Vec{{0, 1, 2}});
  };
  BOOST_TEST(std::isinf(bound({.stiffness = 1})));
  BOOST_TEST(std::abs(bound({}) - 2) < 2 * 4 * eps);  // of the other two: w^2 = 2 k / m
}

BOOST_AUTO_TEST_CASE(nothing_that_moves_or_pulls_has_frequency_zero) {
  BOOST_TEST(bound_at(*make_mass_spring({.dimension = 3}), Vec()) == 0);
  const auto free = make_mass_spring({.gravity = {0, 0, -9.81}, .node_mass = Vec::Ones(2)});
  BOOST_TEST(bound_at(*free, Vec::LinSpaced(6, 0, 1)) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
