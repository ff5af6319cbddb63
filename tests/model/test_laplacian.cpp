#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(laplacian)

using namespace qddot;

namespace {

SymmetricMatrix laplacian_of(const System& system) {
  SymmetricMatrix l = system.stiffness_pattern();
  l.coeffs().setConstant(NAN);  // whatever was in it before
  offered(system.laplacian()).assemble_laplacian(l);
  return l;
}

// Each entry is a sum of a dozen stiffnesses of up to 200 N/m, or 800 across a mirror. Eigenvalues
// of up to 5000 N/m have errors of the same size.
constexpr double rounding = 100 * eps * 5000;

Vec beside(const Vec& q, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  Vec moved = q;
  for (double& x : moved) x += uniform(random);
  return moved;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_minus_the_stiffness_of_the_network_at_rest_lengths_zero) {
  for_networks({1.4, 0.7}, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network),
               straight = make_mass_spring(without_rest_lengths(network));
    const Eigen::MatrixXd l = dense(laplacian_of(*system));
    BOOST_TEST(distance(l, -dense(stiffness_at(*straight, q))) < rounding);
    if (network.zero_coordinates.empty()) {  // nothing in it couples different axes
      for (Index i = 0; i < l.rows(); ++i) {
        for (Index j = 0; j < l.cols(); ++j)
          BOOST_TEST(((i - j) % network.dimension == 0 || l(i, j) == 0));
      }
    }
    // Without the rest lengths taken off it is another matrix.
    BOOST_TEST(distance(l, -dense(stiffness_at(*system, q))) > 1);
  });
}

BOOST_AUTO_TEST_CASE(it_bounds_the_stiffness_of_springs_without_a_quartic_part_at_any_positions) {
  std::mt19937 random(3);
  for_networks({1.4, 0.7}, [&](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(without_quartic(network));
    BOOST_TEST(offered(system->laplacian()).bounds_stiffness());
    const Eigen::MatrixXd l = dense(laplacian_of(*system));
    for (int i = 0; i < 5; ++i) {
      const Eigen::MatrixXd k = dense(stiffness_at(*system, beside(q, random)));
      BOOST_TEST(smallest_eigenvalue(l + k) > -rounding);
    }
  });
}

BOOST_AUTO_TEST_CASE(it_does_not_bound_that_of_long_quartic_springs_and_does_not_say_so) {
  Network network{.dimension = 2, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, {.stiffness = 10, .rest_length = 1, .quartic = 5}}};
  const auto system = make_mass_spring(network);
  BOOST_TEST(!offered(system->laplacian()).bounds_stiffness());
  const Eigen::MatrixXd l = dense(laplacian_of(*system));
  BOOST_TEST((l == 10 * Eigen::MatrixXd::Identity(2, 2)));
  // Along the spring, 3 c (l - l0)^2 = 15 N/m more than k.
  const Eigen::MatrixXd k = dense(stiffness_at(*system, Vec{{2, 0}}));
  BOOST_TEST(std::abs(smallest_eigenvalue(l + k) + 15) < 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()
