#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/algebra/leading_pairs.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(leading_pairs)

using namespace qddot;

namespace {

// Some eigenvalues, each as often as it stands there, above many that fall off to zero.
Vec spectrum(const std::vector<double>& top) {
  Vec values = Vec::LinSpaced(300, 0.01, 0);
  std::ranges::copy(top, values.begin());
  return values;
}

// The operator with these eigenvalues, in a basis turned by a reflection.
Eigen::MatrixXd operator_with(const Vec& values) {
  const Vec normal = Vec::LinSpaced(values.size(), -1, 2).array().sin().matrix().normalized();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(values.size(), values.size());
  basis -= 2 * normal * normal.transpose();
  return basis * values.asDiagonal() * basis;
}

SymmetricOperator product_with(const Eigen::MatrixXd& a) {
  return [&a](const Vec& x, Vec& y) { y = a * x; };
}

}  // namespace

BOOST_AUTO_TEST_CASE(multiple_eigenvalues_are_found_as_often_as_they_are) {
  for (const auto& top : std::vector<std::vector<double>>{{1, 0.5, 0.25, 0.12},
                                                          {1, 1, 0.5, 0.25},
                                                          {1, 1, 1, 1, 1, 1, 0.9, 0.8, 0.7},
                                                          {1, 0.3, 0.3, 0.3, 0.2, 0.2}}) {
    const Eigen::MatrixXd a = operator_with(spectrum(top));
    for (Index count = 1; count <= std::ssize(top); ++count) {
      const auto [values, vectors] = qddot::leading_pairs(product_with(a), a.rows(), count);
      const Vec expected = Vec::Map(top.data(), count);
      // Residuals of 1e-10 make errors of their square; what is left is rounding.
      BOOST_TEST(distance(values, expected) < 1e-13);
      BOOST_TEST(distance(a * vectors, vectors * values.asDiagonal()) < 1e-9);
      BOOST_TEST(distance(vectors.transpose() * vectors,
                          Eigen::MatrixXd::Identity(values.size(), values.size())) < 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(all_equal_eigenvalues_need_no_convergence) {
  const SymmetricOperator identity = [](const Vec& x, Vec& y) { y = x; };
  const auto [values, vectors] = qddot::leading_pairs(identity, 500, 7);
  BOOST_TEST(distance(values, Vec::Ones(7)) < 1e-14);
  BOOST_TEST(distance(vectors.transpose() * vectors, Eigen::MatrixXd::Identity(7, 7)) < 1e-12);
}

BOOST_AUTO_TEST_CASE(leading_value_is_below_the_largest_by_less_than_its_tolerance) {
  for (const double second : {0.5, 0.99, 0.9999, 1.0}) {
    const Eigen::MatrixXd a = operator_with(spectrum({1, second}));
    for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
      const double value = leading_value(product_with(a), a.rows(), tolerance);
      BOOST_TEST(value <= 1 + 1e-14);
      BOOST_TEST(value >= 1 - tolerance);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
