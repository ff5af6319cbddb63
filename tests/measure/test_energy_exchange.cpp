#include <boost/test/unit_test.hpp>

#include "qddot/measure/exchange/energy_exchange.hpp"

BOOST_AUTO_TEST_SUITE(energy_exchange)

using namespace qddot;

namespace {

constexpr double until = 200, window = 5;

using Energy = std::function<double(double t)>;

// Two springs that exchange an energy E(t) to and fro: E cos^2(a t/50), E sin^2(a t/50), and
// vibrate by some tenths of it, unless `ripple` is zero. Seen every 0.21 s, so that the window
// holds about 24 of them.
EnergyCourse course_of(
    double a, double ripple = 0, const Energy& energy = [](double) { return 1; }) {
  EnergyCourse course;
  for (double t = 0; t <= until; t += 0.21) {
    const double c = std::cos(a * t / 50), s = std::sin(a * t / 50);
    const Vec shares = Vec{{c * c, s * s}}.array() + ripple * std::sin(50 * t);
    course.times.push_back(t);
    course.energies.push_back(energy(t) * shares);
  }
  return course;
}

// The factor by which a running mean reduces the waves of cos^2(t/50): sinc(window/50).
const double shrunk = std::sin(window / 50) / (window / 50);

}  // namespace

BOOST_AUTO_TEST_CASE(a_course_is_itself) {
  const ExchangeComparison c = compare(course_of(1), course_of(1), window);
  BOOST_TEST(c.distance == 0);
  BOOST_TEST(c.misfit == 0);
  BOOST_TEST(c.tempo == 1);
  BOOST_TEST(std::abs(c.first - 1) < 1e-12);  // of sums of 1000 times
  BOOST_TEST(std::abs(c.last - 1) < 1e-12);
  BOOST_TEST(std::abs(c.level - 1) < 1e-12);
  // All of it goes over, but for the mean at either end, half a window long at the start.
  BOOST_TEST(std::abs(c.exchanged - 0.5 * (shrunk + 1)) < 2e-3);
}

BOOST_AUTO_TEST_CASE(one_that_is_played_faster_or_slower_is_recognised_by_its_tempo) {
  for (const double a : {0.05, 0.14, 0.43, 0.8, 0.95, 1.1, 1.5, 3.}) {
    for (const double ripple : {0., 0.3}) {
      BOOST_TEST_CONTEXT("tempo " << a << ", ripple " << ripple) {
        const ExchangeComparison c = compare(course_of(a, ripple), course_of(1), window);
        // Found in steps of 0.2 %; what the window shrinks moves it, most where little happens.
        BOOST_TEST(std::abs(c.tempo / a - 1) < (a < 0.1 ? 0.05 : 0.01));
        BOOST_TEST(c.misfit < 0.02);
      }
    }
  }
}

// cos^2 a t - cos^2 t at its largest, shrunk alike where a is near 1.
BOOST_AUTO_TEST_CASE(the_distance_is_that_of_the_means) {
  const double a = 1.05;
  double expected = 0;
  for (double t = 0; t <= until; t += 0.01) {
    expected = std::max(
        expected, std::abs(std::pow(std::cos(a * t / 50), 2) - std::pow(std::cos(t / 50), 2)));
  }
  const ExchangeComparison c = compare(course_of(a), course_of(1), window);
  BOOST_TEST(std::abs(c.distance - expected) < 5e-3);
}

BOOST_AUTO_TEST_CASE(what_is_lost_and_gained_is_told_apart_from_the_exchange) {
  const EnergyCourse exact = course_of(1);
  const auto damped = course_of(1, 0, [](double t) { return std::exp(-t / 100); });
  const ExchangeComparison c = compare(damped, exact, window);
  BOOST_TEST(std::abs(c.last / c.first - std::exp(-2)) < 0.03 * std::exp(-2));
  BOOST_TEST(std::abs(c.level - (1 - std::exp(-2)) / 2) < 1e-3);
  // A constant factor is no loss on the way.
  const auto large = course_of(1, 0, [](double) { return 4.5; });
  const ExchangeComparison d = compare(large, exact, window);
  BOOST_TEST(std::abs(d.first - 4.5) < 1e-11);
  BOOST_TEST(std::abs(d.last - 4.5) < 1e-11);
  BOOST_TEST(std::abs(d.level - 4.5) < 1e-11);
  BOOST_TEST(std::abs(d.distance - 3.5) < 1e-2);
  BOOST_TEST(d.tempo == 1);
  BOOST_TEST(d.misfit < 1e-12);
}

BOOST_AUTO_TEST_CASE(negative_control_an_exchange_with_another_spring_has_no_tempo) {
  EnergyCourse other = course_of(1);
  for (Vec& energies : other.energies) energies = Vec{{energies[0], energies[1], 0}};
  EnergyCourse course = other;
  for (Vec& energies : course.energies) std::swap(energies[1], energies[2]);
  const ExchangeComparison c = compare(course, other, window);
  BOOST_TEST(c.misfit > 0.3);
  BOOST_TEST(c.distance > 0.9);
}

BOOST_AUTO_TEST_CASE(one_that_stands_still_exchanges_nothing) {
  const ExchangeComparison c = compare(course_of(0, 0.3), course_of(1), window);
  BOOST_TEST(c.exchanged < 0.05);  // of the ripple
  BOOST_TEST(c.tempo < 0.05);
  BOOST_TEST(std::abs(c.distance - 1) < 0.05);
}

BOOST_AUTO_TEST_CASE(courses_may_be_seen_at_other_times_and_one_may_end_sooner) {
  EnergyCourse sooner = course_of(1);
  sooner.times.resize(600);
  sooner.energies.resize(600);
  EnergyCourse coarser;
  const EnergyCourse exact = course_of(1);
  for (std::size_t i = 0; i < exact.times.size(); i += 3) {
    coarser.times.push_back(exact.times[i]);
    coarser.energies.push_back(exact.energies[i]);
  }
  for (const EnergyCourse& course : {sooner, coarser}) {
    const ExchangeComparison c = compare(course, exact, window);
    // The trapezia of 0.63 s miss 1/12 0.63^2 cos''.
    BOOST_TEST(c.distance < 1e-3);
    BOOST_TEST(std::abs(c.tempo - 1) < 2e-3);
  }
}

BOOST_AUTO_TEST_SUITE_END()
