#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/hermite.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(hermite)

using namespace qddot;

namespace {

const std::vector<double> times = {0.3, 1.2, 0.55, 0.8, 1.5, 0.1};  // of any order and spacing

// Two coordinates: t^degree, and three times that plus 5.
Instant monomial(double t, int degree) {
  const double q = std::pow(t, degree), v = degree * std::pow(t, degree - 1),
               a = degree * (degree - 1) * std::pow(t, degree - 2);
  return {{t, Vec{{q, 5 + 3 * q}}, Vec{{v, 3 * v}}}, Vec{{a, 3 * a}}};
}

// Instants of a monomial, and where they are.
struct Course {
  std::vector<Instant> list;
  std::vector<const Instant*> pointers;
  Course(std::size_t instants, int degree) {
    for (std::size_t i = 0; i < instants; ++i) list.push_back(monomial(times[i], degree));
    for (const Instant& instant : list) pointers.push_back(&instant);
  }
  Course(const Course&) = delete;
};

State interpolated(std::size_t instants, int degree, double t) {
  State at{0, Vec(2), Vec(2)};
  interpolate(Course(instants, degree).pointers, t, at);
  BOOST_TEST(at.t == t);
  return at;
}

// Rounding of numbers of up to 1e3 by weights of up to 1e3.
constexpr double rounding = 1e-10;

}  // namespace

BOOST_AUTO_TEST_CASE(
    the_error_is_none_up_to_degree_3m_and_then_the_product_of_the_distances_cubed) {
  for (std::size_t m = 2; m <= most_instants; ++m) {
    for (int degree = 2; degree <= 3 * static_cast<int>(m); ++degree) {
      for (const double t : {0.42, 0.6, 0.9}) {
        BOOST_TEST_CONTEXT(m << " instants, degree " << degree << ", t = " << t) {
          double product = degree == 3 * static_cast<int>(m), slope = 0;
          for (std::size_t i = 0; i < m; ++i) {
            product *= std::pow(t - times[i], 3);
            slope += 3 / (t - times[i]);
          }
          const State at = interpolated(m, degree, t), exact = monomial(t, degree).state;
          const Vec both{{product, 3 * product}};
          BOOST_TEST(distance(exact.q - at.q, both) < rounding);
          BOOST_TEST(distance(exact.v - at.v, slope * both) < rounding);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(without_an_instant_the_change_is_the_error_of_the_others) {
  for (std::size_t m = 3; m <= most_instants; ++m) {
    const int degree = 3 * static_cast<int>(m - 1);  // exact with all of them
    const Course course(m, degree);
    for (std::size_t without = 0; without < m; ++without) {
      BOOST_TEST_CONTEXT(m << " instants without " << without) {
        const double t = 0.6;
        double product = 1, slope = 0;
        for (std::size_t i = 0; i < m; ++i) {
          if (i == without) continue;
          product *= std::pow(t - times[i], 3);
          slope += 3 / (t - times[i]);
        }
        const Vec both{{product, 3 * product}};
        Vec q(2), v(2);
        change_without(without, course.pointers, t, q, v);
        BOOST_TEST(distance(q, both) < rounding);
        BOOST_TEST(distance(v, slope * both) < rounding);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(at_an_instant_its_state_is_found) {
  for (std::size_t i = 0; i < 4; ++i) {
    const State at = interpolated(4, 20, times[i]), exact = monomial(times[i], 20).state;
    BOOST_TEST(distance(at.q, exact.q) < 1e-14);
    BOOST_TEST(distance(at.v, exact.v) < rounding);
  }
}

BOOST_AUTO_TEST_SUITE_END()
