#include <limits>
#include <random>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(material_stiffness)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

// K sums some 60 springs of up to 1e4 N/m at a node.
constexpr double rounding = 60 * std::numeric_limits<double>::epsilon() * 1e4;

Network without_quartic(Network network) {
  for (auto& link : network.links) link.law.quartic = 0;
  for (auto& link : network.image_links) link.law.quartic = 0;
  for (auto& anchor : network.anchors) anchor.law.quartic = 0;
  return network;
}

// Networks with every spring at `stretch` times its rest length: the same ones for every stretch.
template <class Check>
void for_networks(double stretch, const Check& check) {
  std::mt19937 random(17);
  for (const int dimension : {1, 2, 3}) {
    const Problem p = random_network(random, dimension, 6, stretch);
    check(p.network, p.initial.q);
    for (const bool on_planes : {false, true}) {
      const ImageSample s = random_images(random, dimension, stretch, on_planes);
      check(s.network, s.q);
    }
  }
}

double largest_eigenvalue(const MatrixXd& k) {
  return k.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
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
  for_networks(1, [](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    const MatrixXd k = dense(stiffness_at(*system, q));
    BOOST_TEST(distance(dense(material_stiffness_at(*system, q)), k) < rounding);
    BOOST_TEST(k.cwiseAbs().maxCoeff() > 10);
  });
}

BOOST_AUTO_TEST_CASE(tension_and_compression_change_nothing) {
  std::vector<MatrixXd> at_rest;
  for_networks(1, [&](const Network& network, const Vec& q) {
    at_rest.push_back(dense(stiffness_at(*make_mass_spring(without_quartic(network)), q)));
  });
  for (const double stretch : {0.7, 1.4}) {
    std::size_t i = 0;
    int differ = 0;
    for_networks(stretch, [&](const Network& network, const Vec& q) {
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
  for_networks(0.7, [&](const Network& network, const Vec& q) {
    const auto system = make_mass_spring(network);
    indefinite += largest_eigenvalue(dense(stiffness_at(*system, q))) > 1;
    BOOST_TEST(largest_eigenvalue(dense(material_stiffness_at(*system, q))) < rounding);
  });
  BOOST_TEST(indefinite >= 4);
}

BOOST_AUTO_TEST_CASE(where_k_is_constant_it_is_k) {
  Problem p = hammock(2);
  for (auto& link : p.network.links) link.law.rest_length = link.law.quartic = 0;
  for (auto& anchor : p.network.anchors) anchor.law.rest_length = anchor.law.quartic = 0;
  const auto system = make_mass_spring(p.network);
  BOOST_TEST_REQUIRE(system->stiffness_is_constant());
  BOOST_TEST((dense(material_stiffness_at(*system, p.initial.q)) ==
              dense(stiffness_at(*system, p.initial.q))));
}

BOOST_AUTO_TEST_CASE(held_unknowns_have_none_and_parts_have_their_own) {
  const Problem p = hammock(2);
  const Index n = p.initial.q.size();
  const auto system = make_mass_spring(p.network);
  const MatrixXd k = dense(material_stiffness_at(*system, p.initial.q));

  std::vector<bool> is_held(static_cast<std::size_t>(n));
  is_held[1] = is_held[6] = true;
  MatrixXd expected = k;
  for (const Index i : {1, 6}) {
    expected.row(i).setZero();
    expected.col(i).setZero();
  }
  const ConstrainedSystem held(make_mass_spring(p.network), is_held);
  BOOST_TEST((dense(material_stiffness_at(held, p.initial.q)) == expected));

  std::vector<std::unique_ptr<System>> parts;
  for (int i = 0; i < 2; ++i) parts.push_back(make_mass_spring(p.network));
  const BlockDiagonalSystem divided(std::move(parts));
  MatrixXd both = MatrixXd::Zero(2 * n, 2 * n);
  both.topLeftCorner(n, n) = both.bottomRightCorner(n, n) = k;
  Vec q(2 * n);
  q << p.initial.q, p.initial.q;
  BOOST_TEST((dense(material_stiffness_at(divided, q)) == both));
}

BOOST_AUTO_TEST_SUITE_END()
