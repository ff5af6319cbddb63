#include <complex>
#include <random>
#include <tuple>

#include <boost/test/unit_test.hpp>

#include "qddot/model/spring.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(spring)

using namespace qddot;

namespace {

using Complex = std::complex<double>;
using Dimensions = std::tuple<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
                              std::integral_constant<int, 3>>;
template <int D>
using Point = Eigen::Matrix<double, D, 1>;
template <int D>
using Block = Eigen::Matrix<double, D, D>;

// A few dozen operations, each rounded once, relative to the largest term.
constexpr double round_off = 32 * eps;

// d + i step e_k. The complex step subtracts nothing, so its only error, step^2, is none.
constexpr double step = 1e-50;
template <int D>
Eigen::Matrix<Complex, D, 1> beside(const Point<D>& d, int k) {
  Eigen::Matrix<Complex, D, 1> moved = d.template cast<Complex>();
  moved[k] += Complex(0, step);
  return moved;
}

// dV/dd = tau n, which is the force on x_i as d = x_j - x_i.
template <int D>
Point<D> gradient(const SpringLaw& law, const Point<D>& d) {
  Point<D> slope;
  for (int k = 0; k < D; ++k) slope[k] = spring_energy(law, beside<D>(d, k)).imag() / step;
  return slope;
}
template <int D>
Block<D> force_jacobian(const SpringLaw& law, const Point<D>& d) {
  Block<D> slope;
  for (int k = 0; k < D; ++k) slope.col(k) = spring_force(law, beside<D>(d, k)).imag() / step;
  return slope;
}

// The largest terms that the force and the block sum up; differences of lengths may cancel.
template <int D>
double force_scale(const SpringLaw& law, const Point<D>& d) {
  const double s = d.norm() + law.rest_length;
  return law.stiffness * s + law.quartic * s * s * s;
}
template <int D>
double block_scale(const SpringLaw& law, const Point<D>& d) {
  const double s = d.norm() + law.rest_length;
  return force_scale<D>(law, d) / d.norm() + law.stiffness + 3 * law.quartic * s * s;
}

// Laws and differences, stretched as well as compressed, calling check(law, d) on each.
template <int D, class Check>
void for_random_springs(const Check& check) {
  std::mt19937 random(D);
  std::uniform_real_distribution<double> coordinate(-2, 2), positive(0.1, 3);
  for (int sample = 0; sample < 200; ++sample) {
    Point<D> d;
    for (double& x : d) x = coordinate(random);
    const double ratio = sample % 4 == 0 ? 0 : positive(random);  // of rest length to length
    check(SpringLaw{positive(random), ratio * d.norm(), sample % 3 == 0 ? 0 : positive(random)}, d);
  }
}

const SpringLaw stiff = {.stiffness = 3, .rest_length = 2, .quartic = 5};

}  // namespace

BOOST_AUTO_TEST_CASE(energy_force_and_block_are_those_computed_by_hand) {
  const Eigen::Vector2d d(3, 4);  // l = 5, n = (0.6, 0.8), s = 3, tau = 144, tau' = 138
  BOOST_TEST(spring_energy(stiff, d) == 114.75);
  BOOST_TEST(distance(spring_force(stiff, d), Eigen::Vector2d(86.4, 115.2)) < 144 * round_off);
  const Block<2> expected{{68.112, 52.416}, {52.416, 98.688}};
  BOOST_TEST(distance(spring_stiffness(stiff, d), expected) < 138 * round_off);
}

BOOST_AUTO_TEST_CASE_TEMPLATE(force_is_the_gradient_of_the_energy, Dimension, Dimensions) {
  constexpr int D = Dimension::value;
  for_random_springs<D>([](const SpringLaw& law, const Point<D>& d) {
    BOOST_TEST(distance(spring_force(law, d), gradient<D>(law, d)) <
               round_off * force_scale<D>(law, d));
  });
}

BOOST_AUTO_TEST_CASE_TEMPLATE(block_is_the_jacobian_of_the_force, Dimension, Dimensions) {
  constexpr int D = Dimension::value;
  for_random_springs<D>([](const SpringLaw& law, const Point<D>& d) {
    const Block<D> b = spring_stiffness(law, d);
    const double tolerance = round_off * block_scale<D>(law, d);
    BOOST_TEST(distance(b, force_jacobian<D>(law, d)) < tolerance);
    BOOST_TEST(distance(b, b.transpose()) < tolerance);
  });
}

BOOST_AUTO_TEST_CASE_TEMPLATE(without_rest_length_the_limit_of_no_length_is_kept, Dimension,
                              Dimensions) {
  constexpr int D = Dimension::value;
  const SpringLaw law = {.stiffness = 3, .quartic = 5};
  for (const double size : {0.0, 5e-324, 1e-300, 1e-162, 1e-160, 1e-100, 1e-10, 1e-3}) {
    const Point<D> d = Point<D>::LinSpaced(-size, size / 2);
    const double l = d.norm();
    // f = k d + c l^2 d and B = k I + c (l^2 I + 2 dd'). Below sqrt(smallest number) the square of
    // the length underflows and the force may be taken as zero: an error of k 1e-161 at most.
    BOOST_TEST(distance(spring_force(law, d), 3 * d) <=
               3 * (round_off * l + 1e-161) + 5 * l * l * l);
    BOOST_TEST(distance(spring_stiffness(law, d), 3 * Block<D>::Identity()) <=
               3 * round_off + 15 * l * l);
    // 1e-322 is a few of the smallest numbers, as which so small an energy is rounded.
    BOOST_TEST(std::abs(spring_energy(law, d) - 1.5 * l * l) <=
               1.5 * l * l * round_off + 2 * l * l * l * l + 1e-322);
  }
  BOOST_TEST((spring_force(law, Point<D>(Point<D>::Zero())) == Point<D>::Zero()));
  BOOST_TEST((spring_stiffness(law, Point<D>(Point<D>::Zero())) == 3 * Block<D>::Identity()));
}

BOOST_AUTO_TEST_CASE_TEMPLATE(at_no_length_a_rest_length_gives_no_force_and_the_tangent, Dimension,
                              Dimensions) {
  constexpr int D = Dimension::value;
  const Point<D> none = Point<D>::Zero();
  BOOST_TEST((spring_force(stiff, none) == none));
  // tau'(0) = k + 3 c l0^2 = 63, in every direction.
  BOOST_TEST((spring_stiffness(stiff, none) == 63 * Block<D>::Identity()));
  // V(0) = k l0^2 / 2 + c l0^4 / 4.
  BOOST_TEST((spring_energy(stiff, none)) == 26.0);
}

BOOST_AUTO_TEST_CASE_TEMPLATE(tiny_lengths_give_finite_symmetric_results, Dimension, Dimensions) {
  constexpr int D = Dimension::value;
  for (const double size : {5e-324, 1e-308, 1e-300, 1.6e-162, 2.5e-162, 1e-160, 1e-155, 1e-20}) {
    for (const double last : {0.0, size, -0.9 * size}) {
      Point<D> d = Point<D>::Constant(size);
      d[D - 1] = last;
      const Block<D> b = spring_stiffness(stiff, d);
      BOOST_TEST(b.allFinite());
      BOOST_TEST(distance(b, b.transpose()) <= round_off * b.cwiseAbs().maxCoeff());
      // |tau| = k l0 + c l0^3 = 46. The squares of the coordinates may lie among the last few
      // numbers above zero. A direction's length is then off by sqrt(2.5) at most.
      BOOST_TEST(spring_force(stiff, d).norm() <= 46 * 1.6);
      BOOST_TEST(spring_energy(stiff, d) == 26.0);  // l is lost beside l0
    }
  }
}

BOOST_AUTO_TEST_CASE(lectures_energy_is_hookes_with_twice_kappa_over_rest_length_squared) {
  const auto lecture = [](double kappa, double l0, double l) {
    return kappa * (1 - l / l0) * (1 - l / l0);
  };
  // Powers of two are divided and squared without rounding, so the two are the same number.
  const SpringLaw hooke = {.stiffness = 2 * 4.0 / (2.0 * 2.0), .rest_length = 2};
  for (const double l : {0.0, 0.5, 1.0, 1.75, 2.0, 3.0, 10.0}) {
    BOOST_TEST(hooke.energy(l) == lecture(4, 2, l));
  }
  const SpringLaw other = {.stiffness = 2 * 3.7 / (1.3 * 1.3), .rest_length = 1.3};
  for (const double l : {0.1, 1.1, 1.9, 7.3}) {
    BOOST_TEST(std::abs(other.energy(l) - lecture(3.7, 1.3, l)) <
               round_off * 3.7 * (1 + l / 1.3) * (1 + l / 1.3));
  }
}

BOOST_AUTO_TEST_SUITE_END()
