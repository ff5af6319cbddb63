// The material part of K, and K with a part of the compression.
#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(split_stiffness)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

// K sums some 60 springs of up to 1e4 N/m at a node.
constexpr double rounding = 60 * eps * 1e4;

MatrixXd weighted_at(const System& system, const Vec& q, double compression) {
  SymmetricMatrix k = system.stiffness_pattern();
  offered(system.split_stiffness()).weighted_stiffness(q, compression, k);
  return dense(k);
}

// K with the tangent of springs along them, and across(tau/l) across them.
template <class Across>
MatrixXd with_across(const Network& network, const Vec& q, const Across& across) {
  return sum_of_blocks<double>(
      network, q, [&](const SpringLaw& law, double l, const Vec& n) -> MatrixXd {
        const MatrixXd along = n * n.transpose(), one = MatrixXd::Identity(n.size(), n.size());
        return law.tangent(l) * along + across(law.tension(l) / l) * (one - along);
      });
}

}  // namespace

BOOST_AUTO_TEST_CASE(springs_push_across_themselves_by_the_part_that_is_kept_or_not_at_all) {
  for_networks({0.5, 0.7, 1.0, 1.3}, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    for (const double kept : {0.0, 0.25, 1.0}) {
      const auto part = [&](double across) { return across < 0 ? kept * across : across; };
      BOOST_TEST(distance(weighted_at(*system, q, kept), with_across(network, q, part)) < rounding);
    }
    const auto none = [](double) { return 0.0; };
    BOOST_TEST(distance(dense(material_stiffness_at(*system, q)), with_across(network, q, none)) <
               rounding);
    BOOST_TEST(distance(weighted_at(*system, q, 1), dense(stiffness_at(*system, q))) == 0);
  });
  for_networks({1.3}, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    BOOST_TEST(distance(weighted_at(*system, q, 0), dense(stiffness_at(*system, q))) == 0);
  });
}

BOOST_AUTO_TEST_CASE(what_compression_makes_indefinite_is_negative_semidefinite_without_it) {
  double largest = 0;
  for_networks({0.5}, [&](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    // Rounding of a dense eigenproblem of up to 18 unknowns.
    const MatrixXd k = weighted_at(*system, q, 0);
    BOOST_TEST(largest_eigenvalue(k) < 100 * eps * k.cwiseAbs().maxCoeff());
    BOOST_TEST(largest_eigenvalue(dense(material_stiffness_at(*system, q))) < rounding);
    largest = std::max(largest, largest_eigenvalue(weighted_at(*system, q, 1)));
  });
  BOOST_TEST(largest > 10);
}

BOOST_AUTO_TEST_CASE(without_rest_length_the_material_part_is_all_of_it) {
  const SpringLaw law{70, 0, 30};
  for (const double l : {0.0, 0.7}) {
    const Eigen::Vector2d d(0, l);
    const Eigen::Matrix2d b = spring_material_stiffness(law, d), whole = spring_stiffness(law, d);
    BOOST_TEST((b == whole));
  }
  const Problem p = hammock(2);
  const auto system = make_mass_spring(without_rest_lengths(p.network));
  BOOST_TEST_REQUIRE(system->stiffness_is_constant());
  BOOST_TEST((dense(material_stiffness_at(*system, p.initial.q)) ==
              dense(stiffness_at(*system, p.initial.q))));
}

BOOST_AUTO_TEST_SUITE_END()
