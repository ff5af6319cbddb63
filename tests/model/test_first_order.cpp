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

// As in test_mass_spring: step and error of the differences of random_network's forces.
constexpr double step = 1e-3, difference_error = 1e-9;

template <class Check>
void for_random_networks(const Check& check) {
  std::mt19937 random(2);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {1.4, 0.7}) check(random_network(random, dimension, 5, stretch));
  }
}

Vec stacked(const Vec& a, const Vec& b) {
  Vec y(a.size() + b.size());
  y << a, b;
  return y;
}

// dy'/dy by differences of y' = (v, M^-1 f(q)).
Eigen::MatrixXd jacobian_by_differences(const System& system, const State& state) {
  const Index n = system.size();
  const auto rate = [&](const Vec& y) {
    return stacked(y.tail(n), force_at(system, y.head(n)).cwiseQuotient(system.mass()));
  };
  return finite_difference_jacobian(rate, stacked(state.q, state.v), step);
}

}  // namespace

BOOST_AUTO_TEST_CASE(filled_matrix_has_the_documented_blocks) {
  for_random_networks([](const Problem& p) {
    const auto system = make_mass_spring(p.network);
    const SymmetricMatrix k = stiffness_at(*system, p.initial.q);
    const Vec s = Vec::LinSpaced(system->size(), 1, 2), e = Vec::LinSpaced(system->size(), -3, 5);
    // Every entry is one product at most, so nothing rounds differently.
    BOOST_TEST(distance(filled(FirstOrderPattern(*system), 7, -2, s, k, e),
                        expected(7, -2, s, k, e)) == 0);
  });
}

BOOST_AUTO_TEST_CASE(rows_ascend_and_every_diagonal_entry_is_stored) {
  for_random_networks([](const Problem& p) {
    const auto system = make_mass_spring(p.network);
    const Index n = system->size();
    const FirstOrderPattern pattern(*system);
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
    const Index lower = system->stiffness_pattern().nonZeros();
    BOOST_TEST(std::ssize(pattern.rows()) == 3 * n + 2 * lower - n);
  });
}

BOOST_AUTO_TEST_CASE(with_inverse_masses_it_is_the_jacobian_of_the_rate) {
  for_random_networks([](const Problem& p) {
    const auto system = make_mass_spring(p.network);
    const Eigen::MatrixXd j =
        filled(FirstOrderPattern(*system), 0, 1, system->mass().cwiseInverse(),
               stiffness_at(*system, p.initial.q), Vec::Zero(system->size()));
    BOOST_TEST(distance(j, jacobian_by_differences(*system, p.initial)) <
               difference_error * j.cwiseAbs().maxCoeff());
  });
}

BOOST_AUTO_TEST_CASE(with_minus_one_and_c_it_is_the_matrix_of_the_implicit_form) {
  for_random_networks([](const Problem& p) {
    const auto system = make_mass_spring(p.network);
    const Index n = system->size();
    const double c = 40;
    // Let F(y, y') = (q' - v, M v' - f(q)) with y = y0 + u and y' = c u. Its derivative by u at u =
    // 0 is dF/dy + c dF/dy'.
    const Vec start = stacked(p.initial.q, p.initial.v);
    const auto residual = [&](const Vec& u) {
      const Vec y = start + u, rate = c * u;
      return stacked(rate.head(n) - y.tail(n),
                     system->mass().cwiseProduct(rate.tail(n)) - force_at(*system, y.head(n)));
    };
    const Eigen::MatrixXd differences =
        finite_difference_jacobian(residual, Vec::Zero(2 * n), step);
    const Eigen::MatrixXd matrix = filled(FirstOrderPattern(*system), c, -1, -Vec::Ones(n),
                                          stiffness_at(*system, p.initial.q), c * system->mass());
    BOOST_TEST(distance(matrix, differences) < difference_error * matrix.cwiseAbs().maxCoeff());
  });
}

BOOST_AUTO_TEST_CASE(no_unknowns_make_an_empty_pattern) {
  const auto system = make_mass_spring({.dimension = 3});
  const FirstOrderPattern pattern(*system);
  BOOST_TEST(pattern.column_starts().size() == 1u);
  BOOST_TEST(pattern.rows().empty());
  BOOST_TEST(filled(pattern, 1, 1, Vec(), system->stiffness_pattern(), Vec()).size() == 0);
}

BOOST_AUTO_TEST_CASE(massless_and_unconnected_nodes_keep_their_places) {
  const auto system = make_mass_spring({.dimension = 2,
                                        .node_mass = Vec{{0, 1, 0, 2}},
                                        .links = {{3, 1, {.stiffness = 5, .rest_length = 1}}}});
  const Vec q = Vec::LinSpaced(8, 0, 1).cwiseAbs2(), one = Vec::Ones(8);
  const SymmetricMatrix k = stiffness_at(*system, q);
  const Eigen::MatrixXd matrix =
      filled(FirstOrderPattern(*system), 3, -1, -one, k, 3 * system->mass());
  BOOST_TEST(distance(matrix, expected(3, -1, -one, k, 3 * system->mass())) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
