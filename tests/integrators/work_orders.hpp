#pragma once

#include <cmath>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/motions.hpp"

namespace qddot {
inline namespace tests {

// The orders that a ladder of steps over one second shows, in q, v and a part of the work.
struct Orders {
  double q, v, work;
};

// The orders over the last five steps of the ladder before rounding shows. `end`: the exact state
// at 1 s.
inline Orders observed_orders(const Method& method, const System& system, const State& start,
                              const State& end, double Work::*part) {
  // Errors below these are rounding.
  constexpr double floor_q = 1e-13, floor_v = 1e-12;
  std::vector<double> h, q, v, work;
  const double factor = method.order >= 6 ? 1.3 : method.order >= 4 ? 1.5 : 2;
  const double first = method.order == 1 ? 512 : method.order == 2 ? 48 : 12;
  const double most = method.order == 1 ? 20'000 : 4'000;
  for (double steps = first; steps < most; steps *= factor) {
    const Run r = run(method, system, start, 1, {.step_size = 1 / std::round(steps)});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    const double error_q = distance(r.state.q, end.q), error_v = distance(r.state.v, end.v);
    if (error_q < floor_q || error_v < floor_v) break;
    h.push_back(-std::log(std::round(steps)));
    q.push_back(std::log(error_q));
    v.push_back(std::log(error_v));
    work.push_back(std::log(std::abs(r.state.work.*part - end.work.*part)));
  }
  BOOST_TEST_REQUIRE(q.size() >= 5u);
  const auto tail = [](const std::vector<double>& x) {
    return Vec(Eigen::Map<const Vec>(x.data() + std::ssize(x) - 5, 5));
  };
  return {slope(tail(h), tail(q)), slope(tail(h), tail(v)), slope(tail(h), tail(work))};
}

// Checks that a method that chooses its steps is within its tolerance, in the motion and in the
// work taken. `end`: the exact state at 1 s.
inline void check_tolerances(const Method& method, const System& system, const State& start,
                             const State& end) {
  double last = INFINITY;
  for (const double rtol : {1e-4, 1e-6, 1e-8}) {
    const Run r = run(method, system, start, 1, {.rtol = rtol});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    // As in the suite `order`: multistep methods err by up to 1100 tolerances.
    const double most = (method.varies_order() ? 2000 : 100) * rtol;
    const double error = distance(r.state, end);
    BOOST_TEST(error < most);
    // Friction takes some 4 J, at rates of up to 20 W.
    BOOST_TEST(std::abs(r.state.work.taken() - end.work.taken()) < 10 * most);
    BOOST_TEST(error < last);
    last = error;
  }
}

}  // namespace tests
}  // namespace qddot
