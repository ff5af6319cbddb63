#include <limits>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(laplacian)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// The network with springs as they would be at rest lengths zero, without quartic parts.
Network twin(Network network) {
  const auto straighten = [](auto& springs) {
    for (auto& spring : springs) spring.law.rest_length = spring.law.quartic = 0;
  };
  straighten(network.links);
  straighten(network.image_links);
  straighten(network.anchors);
  return network;
}

Network without_quartic(Network network) {
  const auto take_off = [](auto& springs) {
    for (auto& spring : springs) spring.law.quartic = 0;
  };
  take_off(network.links);
  take_off(network.image_links);
  take_off(network.anchors);
  return network;
}

SymmetricMatrix laplacian_of(const System& system) {
  SymmetricMatrix l = system.stiffness_pattern();
  l.coeffs().setConstant(NAN);  // whatever was in it before
  offered<Laplacian>(system).laplacian(l);
  return l;
}

SymmetricMatrix clamped_at(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  offered<SplitStiffness>(system).weighted_stiffness(q, 0, k);
  return k;
}

double smallest_eigenvalue(const Eigen::MatrixXd& a) {
  return a.rows() == 0 ? 0 : Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues()[0];
}
double largest_eigenvalue(const Eigen::MatrixXd& a) { return -smallest_eigenvalue(-a); }

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
  for_random_images([](const ImageSample& s) {
    const auto system = make_mass_spring(s.network), straight = make_mass_spring(twin(s.network));
    const Eigen::MatrixXd l = dense(laplacian_of(*system));
    BOOST_TEST(distance(l, -dense(stiffness_at(*straight, s.q))) < rounding);
    // Without the rest lengths taken off it is another matrix.
    BOOST_TEST(distance(l, -dense(stiffness_at(*system, s.q))) > 1);
  });
}

BOOST_AUTO_TEST_CASE(it_bounds_the_stiffness_of_springs_without_a_quartic_part_at_any_positions) {
  std::mt19937 random(3);
  for_random_images([&](const ImageSample& s) {
    const auto system = make_mass_spring(without_quartic(s.network));
    BOOST_TEST(offered<Laplacian>(*system).bounds_stiffness());
    const Eigen::MatrixXd l = dense(laplacian_of(*system));
    for (int i = 0; i < 5; ++i) {
      const Eigen::MatrixXd k = dense(stiffness_at(*system, beside(s.q, random)));
      BOOST_TEST(smallest_eigenvalue(l + k) > -rounding);
    }
  });
}

BOOST_AUTO_TEST_CASE(it_does_not_bound_that_of_long_quartic_springs_and_does_not_say_so) {
  Network network{.dimension = 2, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, {.stiffness = 10, .rest_length = 1, .quartic = 5}}};
  const auto system = make_mass_spring(network);
  BOOST_TEST(!offered<Laplacian>(*system).bounds_stiffness());
  const Eigen::MatrixXd l = dense(laplacian_of(*system));
  BOOST_TEST((l == 10 * Eigen::MatrixXd::Identity(2, 2)));
  // Along the spring, 3 c (l - l0)^2 = 15 N/m more than k.
  const Eigen::MatrixXd k = dense(stiffness_at(*system, Vec{{2, 0}}));
  BOOST_TEST(std::abs(smallest_eigenvalue(l + k) + 15) < 1e-12);
}

BOOST_AUTO_TEST_CASE(nothing_in_it_couples_different_axes) {
  const auto system = make_mass_spring(hammock(3).network);
  const Eigen::MatrixXd l = dense(laplacian_of(*system));
  for (Index i = 0; i < l.rows(); ++i) {
    for (Index j = 0; j < l.cols(); ++j) {
      // The same for each axis.
      BOOST_TEST(l(i, j) == (i % 3 == j % 3 ? l(i - i % 3, j - j % 3) : 0));
    }
  }
  BOOST_TEST(l(0, 3) == -60);
}

BOOST_AUTO_TEST_CASE(that_of_held_unknowns_and_of_parts_is_that_of_their_stiffness) {
  std::mt19937 random(5);
  for (const int dimension : {1, 2, 3}) {
    const Network a = random_network(random, dimension, 6, 1.2).network,
                  b = without_quartic(random_network(random, dimension, 3, 0.8).network);
    const auto parts_of = [](const Network& one, const Network& other) {
      std::vector<std::unique_ptr<System>> parts;
      parts.push_back(make_mass_spring(one));
      parts.push_back(make_mass_spring(other));
      return parts;
    };
    const BlockDiagonalSystem divided(parts_of(a, b)), straight(parts_of(twin(a), twin(b)));
    const Vec q = Vec::LinSpaced(divided.size(), -1, 1);
    BOOST_TEST(distance(dense(laplacian_of(divided)), -dense(stiffness_at(straight, q))) <
               rounding);
    BOOST_TEST(distance(dense(clamped_at(divided, q)), dense(stiffness_at(straight, q))) > 1);
    BOOST_TEST(!divided.bounds_stiffness());
    BOOST_TEST(BlockDiagonalSystem(parts_of(b, b)).bounds_stiffness());

    std::vector<bool> is_held(static_cast<std::size_t>(6 * dimension));
    for (std::size_t i = 0; i < is_held.size(); ++i) is_held[i] = random() % 3 == 0;
    const ConstrainedSystem held(make_mass_spring(a), is_held),
        held_twin(make_mass_spring(twin(a)), is_held);
    const Vec at = Vec::LinSpaced(held.size(), -1, 1);
    BOOST_TEST(distance(dense(laplacian_of(held)), -dense(stiffness_at(held_twin, at))) < rounding);
    BOOST_TEST(!held.bounds_stiffness());
  }
}

BOOST_AUTO_TEST_CASE(clamped_stiffness_is_that_of_stretched_springs_and_never_grows_anything) {
  std::mt19937 random(9);
  double worst = 0;
  for_random_images([&](const ImageSample& s) {
    const auto system = make_mass_spring(s.network);
    const Eigen::MatrixXd k = dense(stiffness_at(*system, s.q)),
                          clamped = dense(clamped_at(*system, s.q));
    BOOST_TEST(largest_eigenvalue(clamped) < rounding);
    // The part removed from compressed springs was positive.
    BOOST_TEST(smallest_eigenvalue(k - clamped) > -rounding);
    worst = std::max(worst, largest_eigenvalue(k));
    const Vec q = beside(s.q, random);
    BOOST_TEST(largest_eigenvalue(dense(clamped_at(*system, q))) < rounding);
  });
  BOOST_TEST(worst > 10);  // K itself does grow something
  // Stretched springs keep all of it.
  const Problem p = random_network(random, 3, 6, 1.3);
  const auto system = make_mass_spring(p.network);
  BOOST_TEST(
      (dense(clamped_at(*system, p.initial.q)) == dense(stiffness_at(*system, p.initial.q))));
}

BOOST_AUTO_TEST_SUITE_END()
