#include <limits>
#include <random>
#include <set>
#include <utility>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(image_links)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// As in test_mass_spring: springs of 0.5 to 15 m.
constexpr double step = 1e-3;
constexpr double difference_error = 1e-9;

double stiffness_error(const ImageSample& s, const SymmetricMatrix& k) {
  const auto system = make_mass_spring(s.network);
  const auto force = [&](const Vec& q) { return force_at(*system, q); };
  return distance(dense(k), finite_difference_jacobian(force, s.q, step)) /
         dense(k).cwiseAbs().maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_CASE(force_is_minus_the_gradient_of_the_potential) {
  for_random_images([](const ImageSample& s) {
    const auto system = make_mass_spring(s.network);
    const auto v = [&](const Vec& q) { return Vec::Constant(1, system->potential(q)); };
    const Vec gradient = finite_difference_jacobian(v, s.q, step).transpose();
    const double scale = std::abs(system->potential(s.q)) + gradient.cwiseAbs().maxCoeff();
    BOOST_TEST(distance(force_at(*system, s.q), -gradient) < difference_error * scale);
  });
}

BOOST_AUTO_TEST_CASE(stiffness_is_the_symmetric_jacobian_of_the_force) {
  for_random_images([](const ImageSample& s) {
    const auto system = make_mass_spring(s.network);
    SymmetricMatrix k = stiffness_at(*system, s.q);
    BOOST_TEST(stiffness_error(s, k) < difference_error);
    k.coeffs()[k.nonZeros() / 2] += 1e-6 * k.coeffs().abs().maxCoeff();  // noticed
    BOOST_TEST(stiffness_error(s, k) > 100 * difference_error);
    system->stiffness(1.5 * s.q, k);  // and forgotten
    system->stiffness(s.q, k);
    BOOST_TEST(distance(dense(k), dense(stiffness_at(*system, s.q))) == 0);
  });
}

BOOST_AUTO_TEST_CASE(pattern_holds_the_lower_blocks_of_nodes_and_joined_pairs_and_no_more) {
  for_random_images([](const ImageSample& s) {
    std::vector<std::vector<int>> unknowns(image_nodes);
    int next = 0;
    for (int i = 0; i < image_nodes; ++i) {
      for (int d = 0; d < s.network.dimension; ++d) {
        if (is_unknown(s.network, i, d)) unknowns[i].push_back(next++);
      }
    }
    std::set<std::pair<int, int>> expected;  // column, row: in the order of storage
    const auto add_block = [&](int i, int j) {
      for (const int a : unknowns[i]) {
        for (const int b : unknowns[j]) expected.insert(std::minmax(a, b));
      }
    };
    for (int i = 0; i < image_nodes; ++i) add_block(i, i);
    for (const auto& link : s.network.links) add_block(link.i, link.j);
    for (const auto& image : s.network.image_links) add_block(image.i, image.j);
    const auto system = make_mass_spring(s.network);
    const SymmetricMatrix& pattern = system->stiffness_pattern();
    std::vector<std::pair<int, int>> stored;
    for (int column = 0; column < pattern.cols(); ++column) {
      for (SymmetricMatrix::InnerIterator entry(pattern, column); entry; ++entry) {
        stored.push_back({column, static_cast<int>(entry.row())});
        BOOST_TEST(entry.value() == 0);
      }
    }
    BOOST_TEST(pattern.isCompressed());
    BOOST_TEST(pattern.cols() == s.q.size());
    BOOST_TEST((stored == std::vector(expected.begin(), expected.end())));
  });
}

BOOST_AUTO_TEST_CASE(a_spring_to_the_own_image_is_twice_as_long_as_the_way_to_the_plane) {
  const double k = 30, l0 = 1.5, x = 0.9;
  for (const int dimension : {1, 2, 3}) {
    for (int d = 0; d < dimension; ++d) {
      Network network{.dimension = dimension, .node_mass = Vec::Ones(1)};
      network.image_links = {
          {0, 0, Eigen::Vector3d::Ones() - 2 * Eigen::Vector3d::Unit(d), {k, l0}}};
      const auto system = make_mass_spring(network);
      const Vec q = Vec::Constant(dimension, x), normal = Vec::Unit(dimension, d);
      BOOST_TEST(std::abs(system->potential(q) - 0.5 * k * std::pow(2 * x - l0, 2)) < 1e-14);
      BOOST_TEST(distance(force_at(*system, q), -2 * k * (2 * x - l0) * normal) < 1e-13);
      // Along the plane it keeps its length.
      BOOST_TEST(distance(dense(stiffness_at(*system, q)), -4 * k * normal * normal.transpose()) <
                 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_image_in_no_mirror_is_a_link) {
  std::mt19937 random(4);
  for (const int dimension : {1, 2, 3}) {
    const Problem p = random_network(random, dimension, 6, 1.3);
    Network images = p.network;
    for (const auto& [i, j, law, holds, stiff, offset] : images.links) {
      images.image_links.push_back({i, j, Eigen::Vector3d::Ones(), law, holds});
    }
    images.links.clear();
    const auto a = make_mass_spring(p.network), b = make_mass_spring(images);
    const Vec& q = p.initial.q;
    // Up to 20 springs of some 1e3 J, N and N/m; a product with 1 may be rounded with a sum.
    const double tolerance = 20 * eps * 1e3;
    BOOST_TEST(std::abs(a->potential(q) - b->potential(q)) < tolerance);
    BOOST_TEST(distance(force_at(*a, q), force_at(*b, q)) < tolerance);
    BOOST_TEST(distance(dense(stiffness_at(*a, q)), dense(stiffness_at(*b, q))) < tolerance);
  }
}

BOOST_AUTO_TEST_CASE(stiffness_is_constant_where_the_laws_of_images_are_linear_too) {
  const auto is_constant = [](const SpringLaw& image, bool may_be = true) {
    Network network{.node_mass = Vec::Ones(2), .links = {{0, 1, {.stiffness = 3}}}};
    network.image_links = {{1, 0, {-1, 1, 1}, image}};
    network.uses_constant_stiffness = may_be;
    const auto system = make_mass_spring(network);
    const Vec a = Vec::LinSpaced(6, 0, 1), b = Vec::LinSpaced(6, 3, -1).cwiseAbs2();
    const auto there = dense(stiffness_at(*system, a)), here = dense(stiffness_at(*system, b));
    BOOST_TEST(image.is_linear() == (distance(here, there) < 30 * eps));
    return system->stiffness_is_constant();
  };
  BOOST_TEST(is_constant({.stiffness = 3}));
  BOOST_TEST(!is_constant({.stiffness = 3, .rest_length = 0.5}));
  BOOST_TEST(!is_constant({.quartic = 1}));
  BOOST_TEST(!is_constant({.stiffness = 3}, false));
}

BOOST_AUTO_TEST_SUITE_END()
