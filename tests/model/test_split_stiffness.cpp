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
  offered<SplitStiffness>(system).weighted_stiffness(q, compression, k);
  return dense(k);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_springs_block_is_the_tangent_along_it_alone) {
  const SpringLaw law{70, 2, 30};
  for (const double l : {1.5, 2.0, 2.7}) {
    const Eigen::Vector3d n = Eigen::Vector3d(2, -1, 3).normalized(), d = l * n;
    const Eigen::Matrix3d b = spring_material_stiffness(law, d);
    BOOST_TEST(distance(b, law.tangent(l) * n * n.transpose()) < 1e-13);
    const Eigen::Matrix3d whole = spring_stiffness(law, d);
    BOOST_TEST((distance(b, whole) < 1e-12) == (l == 2.0));
  }
}

BOOST_AUTO_TEST_CASE(without_rest_length_it_is_the_whole_block) {
  const SpringLaw law{70, 0, 30};
  for (const double l : {0.0, 0.7}) {
    const Eigen::Vector2d d(0, l);
    const Eigen::Matrix2d b = spring_material_stiffness(law, d), whole = spring_stiffness(law, d);
    BOOST_TEST((b == whole));
  }
}

BOOST_AUTO_TEST_CASE(at_no_length_it_is_finite) {
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d b = spring_material_stiffness(SpringLaw{70, 2, 30}, nowhere);
  BOOST_TEST(b.allFinite());
}

BOOST_AUTO_TEST_CASE(where_no_spring_is_in_tension_it_is_all_of_k) {
  for_networks({1.0}, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    const MatrixXd k = dense(stiffness_at(*system, q));
    BOOST_TEST(distance(dense(material_stiffness_at(*system, q)), k) < rounding);
    BOOST_TEST(k.cwiseAbs().maxCoeff() > 10);
  });
}

BOOST_AUTO_TEST_CASE(tension_and_compression_change_nothing) {
  std::vector<MatrixXd> at_rest;
  for_networks({1.0}, [&](const Network& network, const Vec& q) {
    at_rest.push_back(dense(stiffness_at(*make_mass_spring(without_quartic(network)), q)));
  });
  for (const double stretch : {0.7, 1.4}) {
    std::size_t i = 0;
    int differ = 0;
    for_networks({stretch}, [&](const Network& network, const Vec& q) {
      const auto system = make_mass_spring(without_quartic(network));
      BOOST_TEST(distance(dense(material_stiffness_at(*system, q)), at_rest[i]) < rounding);
      differ += distance(dense(stiffness_at(*system, q)), at_rest[i]) > 1;
      ++i;
    });
    BOOST_TEST(differ >= 6);  // in one dimension nothing is across a spring
  }
}

BOOST_AUTO_TEST_CASE(it_is_negative_semidefinite_where_compression_makes_k_indefinite) {
  int indefinite = 0;
  for_networks({0.7}, [&](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    indefinite += largest_eigenvalue(dense(stiffness_at(*system, q))) > 1;
    BOOST_TEST(largest_eigenvalue(dense(material_stiffness_at(*system, q))) < rounding);
  });
  BOOST_TEST(indefinite >= 4);
}

BOOST_AUTO_TEST_CASE(where_k_is_constant_it_is_k) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(without_rest_lengths(p.network));
  BOOST_TEST_REQUIRE(system->stiffness_is_constant());
  BOOST_TEST((dense(material_stiffness_at(*system, p.initial.q)) ==
              dense(stiffness_at(*system, p.initial.q))));
}

BOOST_AUTO_TEST_CASE(with_all_of_the_compression_it_is_k_itself) {
  for_networks({0.7}, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    BOOST_TEST(distance(weighted_at(*system, q, 1), dense(stiffness_at(*system, q))) == 0);
  });
}

BOOST_AUTO_TEST_CASE(without_it_k_is_negative_semidefinite_with_it_it_need_not_be) {
  double largest = 0;
  for_networks({0.5}, [&](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    const MatrixXd k = weighted_at(*system, q, 0);
    // Rounding of a dense eigenproblem of up to 18 unknowns.
    BOOST_TEST(largest_eigenvalue(k) < 100 * eps * k.cwiseAbs().maxCoeff());
    largest = std::max(largest, largest_eigenvalue(weighted_at(*system, q, 1)));
  });
  BOOST_TEST(largest > 10);
}

BOOST_AUTO_TEST_CASE(it_is_linear_in_the_part_of_the_compression_that_is_kept) {
  for_networks({0.7}, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    const MatrixXd none = weighted_at(*system, q, 0), all = weighted_at(*system, q, 1);
    const MatrixXd expected = none + 0.25 * (all - none);
    BOOST_TEST(distance(weighted_at(*system, q, 0.25), expected) <
               50 * eps * all.cwiseAbs().maxCoeff());
  });
}

BOOST_AUTO_TEST_CASE(springs_in_tension_and_springs_on_a_line_keep_all_of_theirs) {
  for_networks({1.3}, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    BOOST_TEST(distance(weighted_at(*system, q, 0), dense(stiffness_at(*system, q))) == 0);
  });
  std::mt19937 random(35);
  const Problem p = random_network(random, 1, 6, 0.5);
  const auto system = make_mass_spring(p.network);
  BOOST_TEST(distance(weighted_at(*system, p.initial.q, 0),
                      dense(stiffness_at(*system, p.initial.q))) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
