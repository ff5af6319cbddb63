#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(weighted_stiffness)

using namespace qddot;

namespace {

Eigen::MatrixXd weighted_at(const System& system, const Vec& q, double compression) {
  SymmetricMatrix k = system.stiffness_pattern();
  offered<SplitStiffness>(system).weighted_stiffness(q, compression, k);
  return dense(k);
}

template <class Check>
void for_systems(double stretch, const Check& check) {
  for_networks({stretch},
               [&](const Network& network, const Vec& q) { check(*make_mass_spring(network), q); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(all_of_the_compression_is_k_itself) {
  for_systems(0.7, [](const System& system, const Vec& q) {
    BOOST_TEST(distance(weighted_at(system, q, 1), dense(stiffness_at(system, q))) == 0);
  });
}

BOOST_AUTO_TEST_CASE(without_it_k_is_negative_semidefinite_with_it_it_need_not_be) {
  double largest = 0;
  for_systems(0.5, [&](const System& system, const Vec& q) {
    const Eigen::MatrixXd k = weighted_at(system, q, 0);
    // Rounding of a dense eigenproblem of up to 18 unknowns.
    BOOST_TEST(largest_eigenvalue(k) < 100 * eps * k.cwiseAbs().maxCoeff());
    largest = std::max(largest, largest_eigenvalue(weighted_at(system, q, 1)));
  });
  BOOST_TEST(largest > 10);
}

BOOST_AUTO_TEST_CASE(it_is_linear_in_the_part_of_the_compression_that_is_kept) {
  for_systems(0.7, [](const System& system, const Vec& q) {
    const Eigen::MatrixXd none = weighted_at(system, q, 0), all = weighted_at(system, q, 1);
    const Eigen::MatrixXd expected = none + 0.25 * (all - none);
    BOOST_TEST(distance(weighted_at(system, q, 0.25), expected) <
               50 * eps * all.cwiseAbs().maxCoeff());
  });
}

BOOST_AUTO_TEST_CASE(springs_in_tension_and_springs_on_a_line_keep_all_of_theirs) {
  for_systems(1.3, [](const System& system, const Vec& q) {
    BOOST_TEST(distance(weighted_at(system, q, 0), dense(stiffness_at(system, q))) == 0);
  });
  std::mt19937 random(35);
  const Problem p = random_network(random, 1, 6, 0.5);
  const auto system = make_mass_spring(p.network);
  BOOST_TEST(distance(weighted_at(*system, p.initial.q, 0),
                      dense(stiffness_at(*system, p.initial.q))) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
