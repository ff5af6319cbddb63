#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/model/time_curve.hpp"

using namespace qddot;

BOOST_AUTO_TEST_SUITE(time_curve)

namespace {

using Vector = Eigen::Vector3d;

// A cubic with any coefficients.
Vector cubic(double t) {
  return Vector(1, -2, 0.5) + t * Vector(0.3, 0, 2) + t * t * Vector(-1, 1, 0) +
         t * t * t * Vector(0.2, -0.1, 0.7);
}

std::vector<double> uneven_times(int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(0.3 * i + 0.1 * std::sin(1.7 * i));
  return times;
}

template <class F>
PiecewiseCubic spline_of(const F& f, const std::vector<double>& times) {
  std::vector<Vector> values;
  for (const double t : times) values.push_back(f(t));
  return PiecewiseCubic::spline(times, values);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_spline_is_the_polynomial_that_its_values_are_of) {
  // The line through two values, the parabola through three, the cubic through four and more.
  for (const int count : {2, 3, 4, 5, 9}) {
    const auto of_degree = [&](double t) -> Vector {
      const Vector line = cubic(0) + t * Vector(0.3, 0, 2);
      if (count == 2) return line;
      if (count == 3) return line + t * t * Vector(-1, 1, 0);
      return cubic(t);
    };
    const auto times = uneven_times(count);
    const PiecewiseCubic spline = spline_of(of_degree, times);
    for (double t = times.front(); t < times.back(); t += 0.01) {
      BOOST_TEST((spline.at(t, t) - of_degree(t)).norm() <
                 1e-13);  // some roundings of numbers near 1
    }
  }
}

BOOST_AUTO_TEST_CASE(a_spline_of_a_smooth_curve_has_order_four) {
  const auto wave = [](double t) { return Vector(std::sin(t), std::cos(2 * t), 0); };
  const auto error = [&](int count) {
    std::vector<double> times;
    for (int i = 0; i <= count; ++i) times.push_back(3. * i / count);
    const PiecewiseCubic spline = spline_of(wave, times);
    double largest = 0;
    for (double t = 0; t < 3; t += 0.003)
      largest = std::max(largest, (spline.at(t, t) - wave(t)).norm());
    return largest;
  };
  const double order = std::log2(error(32) / error(64));
  BOOST_TEST(order > 3.7);
  BOOST_TEST(order < 4.4);
}

BOOST_AUTO_TEST_CASE(two_derivatives_are_continuous_and_the_ends_rest) {
  const auto wave = [](double t) { return Vector(std::sin(3 * t), std::cos(2 * t), t); };
  const auto times = uneven_times(7);
  const PiecewiseCubic spline = spline_of(wave, times);
  for (std::size_t i = 1; i + 1 < times.size(); ++i) {
    const auto before = spline.derivatives(times[i], std::nextafter(times[i], 0)),
               after = spline.derivatives(times[i], times[i]);
    for (const std::size_t k : {0u, 1u, 2u}) BOOST_TEST((before[k] - after[k]).norm() < 1e-11);
  }
  BOOST_TEST(spline.at(times.front() - 1, times.front() - 1) == wave(times.front()));
  BOOST_TEST(spline.at(times.back() + 1, times.back() + 1) == wave(times.back()));
  BOOST_TEST(spline.rate(times.back() + 1, times.back() + 1).norm() == 0);
}

BOOST_AUTO_TEST_CASE(the_rate_is_the_derivative) {
  TimeCurve curve{.polynomial = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {0.1, 0, 0}},
                  .harmonics = {{{1, 2, 0}, 5, 0.3}, {{0, 0, 1}, 0, 1}}};
  curve.tables.push_back(
      spline_of([](double t) { return Vector(t * t, 1, std::sin(t)); }, uneven_times(6)));
  curve.own.push_back({[](double t) { return Vector(std::exp(-t), 0, 0); },
                       [](double t) { return Vector(-std::exp(-t), 0, 0); }});
  const Eigen::Matrix3d turn = Eigen::Matrix3d::Random();
  const TimeCurve turned = curve.turned(turn);
  for (const double t : {0.123, 0.7, 1.4}) {
    const double e = 1e-5;
    const Vector rate = (curve.at(t + e) - curve.at(t - e)) / (2 * e);
    // e^2 times the third derivative, and rounding over e.
    BOOST_TEST((curve.rate(t) - rate).norm() < 5e-8);
    BOOST_TEST((turned.at(t) - turn * curve.at(t)).norm() < 1e-14);
    BOOST_TEST((turned.rate(t) - turn * curve.rate(t)).norm() < 1e-13);
  }
  const Vector before = curve.at(1);
  curve.shift({1, 2, 3});
  BOOST_TEST((curve.at(1) - before - Vector(1, 2, 3)).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(corners_are_where_derivatives_jump) {
  TimeCurve curve{.harmonics = {{{1, 2, 0}, 5, 0.3}}};
  BOOST_TEST(curve.corners().empty());
  curve.tables.push_back(PiecewiseCubic::straight({0, 1, 3}, {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}));
  for (const Corner& corner : curve.corners()) BOOST_TEST(corner.order == 1);
  curve.tables = {spline_of(cubic, uneven_times(5))};
  const auto corners = curve.corners();
  BOOST_TEST_REQUIRE(corners.size() == 5);
  BOOST_TEST(corners.front().order == 1);
  BOOST_TEST(corners[2].order == 3);
}

BOOST_AUTO_TEST_CASE(curves_are_near_if_all_their_vectors_are) {
  const TimeCurve curve{.polynomial = {{1, 0, 0}}, .harmonics = {{{1, 2, 0}, 5, 0.3}}};
  TimeCurve other = curve;
  other.harmonics[0].amplitude[0] += 1e-6;
  BOOST_TEST(curve.is_near(other, 2e-6));
  BOOST_TEST(!curve.is_near(other, 5e-7));
  other.harmonics[0].phase = 0.4;
  BOOST_TEST(!curve.is_near(other, 1));
}

BOOST_AUTO_TEST_SUITE_END()
