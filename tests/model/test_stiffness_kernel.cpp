#include <limits>
#include <omp.h>

#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(stiffness_kernel)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

Vec values(const System& system, const Vec& q, double compression) {
  SymmetricMatrix k = system.stiffness_pattern();
  k.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());  // every one must be written
  offered<SplitStiffness>(system).weighted_stiffness(q, compression, k);
  return k.coeffs();
}
Vec material_values(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  k.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  offered<SplitStiffness>(system).material_stiffness(q, k);
  return k.coeffs();
}

// The sum over all springs of the stiffest that any is at lengths up to l.
double stiffest_sum(const Network& network, double l) {
  double sum = 0;
  const auto add = [&](const SpringLaw& law) {
    sum += law.stiffness + 3 * law.quartic * (l + law.rest_length) * (l + law.rest_length);
  };
  for (const auto& link : network.links) add(link.law);
  for (const auto& link : network.image_links) add(link.law);
  for (const auto& anchor : network.anchors) add(anchor.law);
  return sum;
}

// tau/l of a spring at least 0.3 m long is rounded ten times in proportion to (l + l0)/l <= 10.
void check_against_plain(const Network& network, const Vec& q) {
  const auto plain = make_mass_spring(network, Forces::spring_by_spring);
  const auto fast = make_mass_spring(network, Forces::by_vectors);
  const double extent = 2 * q.lpNorm<Eigen::Infinity>() + 1;
  const double allowed = 100 * eps * stiffest_sum(network, extent);
  for (const double compression : {1.0, 0.3, 0.0}) {
    const Vec exact = values(*plain, q, compression), own = values(*fast, q, compression);
    BOOST_TEST((exact - own).lpNorm<Eigen::Infinity>() <= allowed);
  }
  const Vec exact = material_values(*plain, q), own = material_values(*fast, q);
  BOOST_TEST((exact - own).lpNorm<Eigen::Infinity>() <= allowed);
}

Network grid(int side, Vec& q) {
  Network network{.dimension = 3, .node_mass = Vec::Ones(side * side)};
  q = Vec(3 * side * side);
  const auto join = [&](int i, int j, int i2, int j2) {
    if (i2 >= side || j2 >= side || j2 < 0) return;
    network.links.push_back({i * side + j, i2 * side + j2, {100, 0.8 + 0.01 * (i % 5 + j % 3)}});
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      q.segment(3 * (i * side + j), 3) << i + 0.1 * std::sin(j), j + 0.1 * std::cos(3 * i),
          0.2 * std::sin(i * j);
      join(i, j, i + 1, j);
      join(i, j, i, j + 1);
      join(i, j, i + 1, j + 1);
      join(i, j, i + 1, j - 1);
    }
  }
  return network;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_the_plain_sum_on_networks_of_all_kinds) {
  std::mt19937 random(4);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.7, 1.3}) {
      for (const int nodes : {1, 2, 7, 8, 9, 40}) {
        const Problem p = random_network(random, dimension, nodes, stretch);
        check_against_plain(p.network, p.initial.q);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_plain_sum_with_images_and_planes) {
  for_random_images([](const ImageSample& s) { check_against_plain(s.network, s.q); });
}

BOOST_AUTO_TEST_CASE(it_is_the_plain_sum_on_a_grid) {
  Vec q;
  const Network network = grid(13, q);
  check_against_plain(network, q);
}

// As in spring.hpp: along it in every direction.
BOOST_AUTO_TEST_CASE(a_spring_of_no_length_is_stiff_in_every_direction) {
  for (const int dimension : {1, 2, 3}) {
    for (const double rest : {0.0, 0.5}) {
      Network network{.dimension = dimension, .node_mass = Vec::Ones(2)};
      network.links = {{0, 1, {100, rest, 10}}};
      check_against_plain(network, Vec::Constant(2 * dimension, 0.3));
    }
  }
}

// Springs that join the same nodes, with images of them, share a block.
BOOST_AUTO_TEST_CASE(springs_beside_each_other_add) {
  Network network{.dimension = 2, .node_mass = Vec::Ones(20)};
  Vec q = Vec::LinSpaced(40, 0, 13).array().sin() + Vec::LinSpaced(40, 0, 7).array();
  for (int i = 0; i + 1 < 20; ++i) {
    network.links.push_back({i, i + 1, {100, 0.3}});
    if (i % 3 == 0) network.links.push_back({i + 1, i, {70, 0.2}});
    if (i % 4 == 0) network.image_links.push_back({i, i + 1, {-1, 1, 1}, {50, 0.4}});
    if (i % 5 == 0) network.links.push_back({i, i + 1, {0, 0.4}});
  }
  check_against_plain(network, q);
}

BOOST_AUTO_TEST_CASE(it_is_the_same_to_the_bit_with_any_number_of_threads) {
  const int before = omp_get_max_threads();
  Vec q;
  const auto system = make_mass_spring(grid(150, q), Forces::by_vectors);
  omp_set_num_threads(1);
  const Vec alone = values(*system, q, 0.5);
  for (const int threads : {2, 3, 8}) {
    omp_set_num_threads(threads);
    BOOST_TEST((values(*system, q, 0.5).array() == alone.array()).all());
  }
  omp_set_num_threads(before);
}

BOOST_AUTO_TEST_SUITE_END()
