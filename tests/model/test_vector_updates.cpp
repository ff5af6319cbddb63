#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

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
    const Vec x = Vec::Random(n), z = Vec::Random(n);
    const Mass m(Vec::Random(n).array() + 2);
    const double c = 0.3;
    const Vec scaled = x + c * z, quotient = x + c * z.cwiseQuotient(m);
    Vec out(n);
    add_scaled(x, c, z, out);
    BOOST_TEST(out.isApprox(scaled, rounding));
    add_quotient(x, c, z, m, out);
    BOOST_TEST(out.isApprox(quotient, rounding));
    divide(z, m, out);
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

// Quotients have the bits of the processor's division: by masses alike or not, with or without
// inverses, of forces of any size, next to the middle of two numbers, and of both zeros.
BOOST_AUTO_TEST_CASE(quotients_are_the_nearest_numbers) {
  std::mt19937_64 random(11);
  const auto number = [&](int exponent) {
    const double mantissa = std::uniform_real_distribution<double>(1, 2)(random);
    const bool is_negative = random() % 2;
    return std::ldexp(is_negative ? -mantissa : mantissa, exponent);
  };
  const auto exponent = [&](int most) {
    return std::uniform_int_distribution<int>(-most, most)(random);
  };
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::array<double, 8> special = {0.0,       -0.0,      0x1p-800, 0x1p800,
                                         0x1p-1074, -0x1p1000, 0x1p-400, inf};
  constexpr Index n = 67;
  for (int trial = 0; trial < 20000; ++trial) {
    Vec m(n), f(n), out(n);
    const int most_of_m = trial % 5 == 4 ? 260 : trial % 5 == 3 ? 199 : 3;
    const double same = std::abs(number(exponent(most_of_m)));
    for (Index i = 0; i < n; ++i) {
      m[i] = trial % 2 ? same : std::abs(number(exponent(most_of_m)));
      f[i] = number(exponent(trial % 3 ? 20 : 790));
      if (trial % 7 == 0 && i % 5 == 0) f[i] = special[random() % special.size()];
      // Next to m times a number or the middle of two: there the last rounding is decided.
      if (trial % 4 == 1) f[i] = m[i] * number(0) * (1 + exponent(1) * eps / 2);
    }
    const Mass mass(m);
    divide(f, mass, out);
    const Vec expected = f.cwiseQuotient(m);
    BOOST_REQUIRE(std::memcmp(out.data(), expected.data(), n * sizeof(double)) == 0);
    BOOST_REQUIRE(mass.is_uniform() == (trial % 2 && same >= 0x1p-200 && same <= 0x1p200));
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
