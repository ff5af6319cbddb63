#include <limits>

#include <boost/test/unit_test.hpp>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(weighted_stiffness)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

Eigen::MatrixXd weighted_at(const System& system, const Vec& q, double compression) {
  SymmetricMatrix k = system.stiffness_pattern();
  offered<SplitStiffness>(system).weighted_stiffness(q, compression, k);
  return dense(k);
}

double largest_eigenvalue(const Eigen::MatrixXd& k) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues().maxCoeff();
}

template <class Check>
void for_systems(double stretch, const Check& check) {
  std::mt19937 random(34);
  for (const int dimension : {1, 2, 3}) {
    for (int sample = 0; sample < 3; ++sample) {
      const Problem p = random_network(random, dimension, 6, stretch);
      check(*make_mass_spring(p.network), p.initial.q);
      const ImageSample s = random_images(random, dimension, stretch, sample == 1);
      check(*make_mass_spring(s.network), s.q);
    }
  }
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

BOOST_AUTO_TEST_CASE(held_unknowns_and_parts_follow) {
  std::mt19937 random(36);
  const Problem p = random_network(random, 2, 4, 0.6);
  const auto system = make_mass_spring(p.network);
  const Vec& q = p.initial.q;
  std::vector<bool> is_held(static_cast<std::size_t>(q.size()));
  is_held[3] = true;
  const ConstrainedSystem held(make_mass_spring(p.network), is_held);
  Eigen::MatrixXd expected = weighted_at(*system, q, 0.5);
  expected.row(3).setZero();
  expected.col(3).setZero();
  BOOST_TEST(distance(weighted_at(held, q, 0.5), expected) == 0);

  std::vector<std::unique_ptr<System>> parts;
  for (int i = 0; i < 2; ++i) parts.push_back(make_mass_spring(p.network));
  const BlockDiagonalSystem divided(std::move(parts));
  Vec both(2 * q.size());
  both << q, 1.1 * q;
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(both.size(), both.size());
  blocks.topLeftCorner(q.size(), q.size()) = weighted_at(*system, q, 0.5);
  blocks.bottomRightCorner(q.size(), q.size()) = weighted_at(*system, 1.1 * q, 0.5);
  BOOST_TEST(distance(weighted_at(divided, both, 0.5), blocks) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
