#include <algorithm>

#include <boost/test/unit_test.hpp>

#include "qddot/model/first_order.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(first_order)

using namespace qddot;

namespace {

// The entries that fill() writes, at their places; those it does not write stay NaN.
Eigen::MatrixXd filled(const FirstOrderPattern& pattern, double alpha, double beta, const Vec& s,
                       const SymmetricMatrix& k, const Vec& e) {
  std::vector<double> values(pattern.rows().size(), NAN);
  pattern.fill(alpha, beta, s, k, e, values.data());
  const Index size = std::ssize(pattern.column_starts()) - 1;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (Index column = 0; column < size; ++column) {
    for (auto p = pattern.column_starts()[column]; p < pattern.column_starts()[column + 1]; ++p) {
      matrix(pattern.rows()[p], column) += values[p];  // so that an entry stored twice shows
    }
  }
  return matrix;
}

Eigen::MatrixXd expected(double alpha, double beta, const Vec& s, const SymmetricMatrix& k,
                         const Vec& e) {
  const Index n = s.size();
  Eigen::MatrixXd matrix(2 * n, 2 * n);
  matrix << alpha * Eigen::MatrixXd::Identity(n, n), beta * Eigen::MatrixXd::Identity(n, n),
      s.asDiagonal() * dense(k), Eigen::MatrixXd(e.asDiagonal());
  return matrix;
}

// Random networks, one with a node on no spring, and none at all.
template <class Check>
void for_networks(const Check& check) {
  std::mt19937 random(2);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {1.4, 0.7}) {
      const Problem p = random_network(random, dimension, 5, stretch);
      check(*make_mass_spring(p.network), p.initial.q);
    }
  }
  check(*make_mass_spring({.dimension = 2,
                           .node_mass = Vec{{0, 1, 0, 2}},
                           .links = {{3, 1, {.stiffness = 5, .rest_length = 1}}}}),
        Vec::LinSpaced(8, 0, 1).cwiseAbs2());
  check(*make_mass_spring({.dimension = 3}), Vec());
}

}  // namespace

BOOST_AUTO_TEST_CASE(filled_matrix_has_the_documented_blocks) {
  for_networks([](const System& system, const Vec& q) {
    const SymmetricMatrix k = stiffness_at(system, q);
    const Vec s = Vec::LinSpaced(system.size(), 1, 2), e = Vec::LinSpaced(system.size(), -3, 5);
    // Every entry is one product at most, so nothing rounds differently.
    BOOST_TEST(
        distance(filled(FirstOrderPattern(system), 7, -2, s, k, e), expected(7, -2, s, k, e)) == 0);
  });
}

BOOST_AUTO_TEST_CASE(rows_ascend_and_every_diagonal_entry_is_stored) {
  for_networks([](const System& system, const Vec&) {
    const Index n = system.size();
    const FirstOrderPattern pattern(system);
    const auto& starts = pattern.column_starts();
    BOOST_TEST(std::ssize(starts) == 2 * n + 1);
    BOOST_TEST(starts.front() == 0);
    BOOST_TEST(starts.back() == std::ssize(pattern.rows()));
    for (Index column = 0; column < 2 * n; ++column) {
      const auto first = pattern.rows().begin() + starts[column];
      const auto last = pattern.rows().begin() + starts[column + 1];
      BOOST_TEST((std::adjacent_find(first, last, std::greater_equal<>()) == last));
      BOOST_TEST(std::count(first, last, column) == 1);
    }
    // alpha, beta and diag(e) besides the full K.
    const Index lower = system.stiffness_pattern().nonZeros();
    BOOST_TEST(std::ssize(pattern.rows()) == 3 * n + 2 * lower - n);
  });
}

BOOST_AUTO_TEST_SUITE_END()
