#include <boost/test/unit_test.hpp>

#include "qddot/model/vector_updates.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(vector_updates)

using namespace qddot;

// Whole vectors of any width and what is left over. A sum of two rounds by half an epsilon of each;
// a fused one by less.
BOOST_AUTO_TEST_CASE(they_are_what_their_formulas_say) {
  constexpr double rounding = 2 * eps;
  for (Index n = 0; n < 20; ++n) {
    const Vec x = Vec::Random(n), z = Vec::Random(n), m = Vec::Random(n).array() + 2;
    const double c = 0.3;
    const Vec scaled = x + c * z, quotient = x + c * z.cwiseQuotient(m);
    Vec out(n);
    add_scaled(x, c, z, out);
    BOOST_TEST(out.isApprox(scaled, rounding));
    add_quotient(x, c, z, m, out);
    BOOST_TEST(out.isApprox(quotient, rounding));
    divide(z, m, out);
    BOOST_TEST(out == Vec(z.cwiseQuotient(m)));
    multiply(z, m, out);
    BOOST_TEST(out == Vec(z.cwiseProduct(m)));
    // In place.
    out = x;
    add_quotient(out, c, z, m, out);
    BOOST_TEST(out.isApprox(quotient, rounding));
    out = z;
    add_scaled(x, c, out, out);
    BOOST_TEST(out.isApprox(scaled, rounding));
  }
}

// Sums of s products in any order round by at most s halves of an epsilon of their terms' sizes.
BOOST_AUTO_TEST_CASE(combinations_are_products_with_columns) {
  for (Index n = 1; n < 80; n += 3) {
    const Eigen::MatrixXd k = Eigen::MatrixXd::Random(n, 5);
    const Vec x = Vec::Random(n), y = Vec::Random(n);
    const std::vector<double> b = {0.3, -2, 1, 0.5};
    const Vec weights = Eigen::Map<const Vec>(b.data(), 4);
    const Vec product = k.leftCols(4) * weights;
    const double rounding = 5 * eps * (k.leftCols(4).cwiseAbs() * weights.cwiseAbs()).maxCoeff();
    Vec out(n);
    add_combination(x, 0.7, k, b, out);
    BOOST_TEST((out - (x + 0.7 * product)).lpNorm<Eigen::Infinity>() <= rounding + eps);
    add_combination(x, 0.3, y, 0.7, k, b, out);
    BOOST_TEST((out - (x + 0.3 * y + 0.7 * product)).lpNorm<Eigen::Infinity>() <=
               rounding + 2 * eps);
    set_combination(0.7, k, b, out);
    BOOST_TEST((out - 0.7 * product).lpNorm<Eigen::Infinity>() <= rounding);
    const std::vector<const double*> columns = {k.col(0).data(), k.col(1).data(), k.col(2).data(),
                                                k.col(3).data()};
    set_combination(columns, b.data(), out);
    BOOST_TEST((out - product).lpNorm<Eigen::Infinity>() <= rounding);
    BOOST_TEST(std::abs(squared_norm(x) - x.squaredNorm()) <=
               static_cast<double>(n) * eps * x.squaredNorm());
    const double error = (x.array() / (0.2 * y.array().abs() + 0.1)).square().sum();
    // Each term rounds four times more, the square twice as much.
    BOOST_TEST(std::abs(squared_error(x, 0.2, y, 0.1) - error) <=
               static_cast<double>(n + 8) * eps * error);
  }
}

BOOST_AUTO_TEST_SUITE_END()
