#include <boost/test/unit_test.hpp>

#include "tests/integrators/motions.hpp"

BOOST_AUTO_TEST_SUITE(implicit_methods)

using namespace qddot;

namespace {

// A free body of four masses in 3D that turns and swings by large amounts: springs of 1 m shorten
// and lengthen by a third.
Problem tumbling() {
  Problem p{{.dimension = 3, .node_mass = Vec{{1, 2, 1.5, 0.7}}}, {}};
  p.initial.q = Vec{{0, 0, 0, 1.3, 0, 0, 0.2, 0.8, 0, 0.1, 0.3, 1.2}};
  p.initial.v = Vec{{0, 3, 0, 0, -2, 1, 2, 0, -3, -1, 0, 2}};
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) p.network.links.push_back({i, j, {100, 1, i == 0 ? 30. : 0.}});
  }
  return p;
}

// The change of the energy in 1000 steps of h w about 1.
double energy_change(const char* method, double solve_tolerance) {
  const Problem p = tumbling();
  const auto system = make_mass_spring(p.network);
  const Run r = run(method_named(method), *system, p.initial, 50,
                    {.step_size = 0.05, .solve_tolerance = solve_tolerance});
  BOOST_REQUIRE(r.summary.message == "");
  return std::abs(total_energy(*system, r.state) - total_energy(*system, p.initial));
}

constexpr double tight = 1e-13;  // a solve_tolerance that only rounding ends

}  // namespace

BOOST_AUTO_TEST_CASE(hht_without_damping_is_the_trapezoidal_rule) {
  const Problem p = hammock(2);
  const Run newmark = run(method_named("trapezoidal"), p, 1, {.step_size = 0.02});
  const Run hht = run(method_named("hht"), p, 1, {.step_size = 0.02, .spectral_radius = 1});
  // The same equations, and so the same iterations but for rounding.
  BOOST_TEST(distance(newmark.state, hht.state) < 1e-11);
  BOOST_TEST(newmark.summary.counts == hht.summary.counts);
}

BOOST_AUTO_TEST_CASE(the_discrete_gradient_keeps_the_energy_at_large_steps_others_do_not) {
  // The energy is 50 J. Each step rounds some 1e-15 of it and leaves 1e-9 of the error of its
  // prediction. That error is up to 0.05 m or 1 m/s, with masses of 2 kg at 3 m/s.
  BOOST_TEST(energy_change("discrete_gradient", 0) < 5e-6);
  BOOST_TEST(energy_change("discrete_gradient", tight) < 1e-9);
  for (const char* method : {"trapezoidal", "implicit_midpoint", "bdf2", "generalized_alpha"}) {
    BOOST_TEST(energy_change(method, tight) > 1e-2);
  }
}

BOOST_AUTO_TEST_CASE(what_solves_leave_is_their_tolerance_of_the_method_s_own_error) {
  const Problem p = hammock(2);
  const State truth = KnownMotion("hammock", p).end;
  for (const char* method : {"implicit_euler", "trapezoidal", "bdf2", "trbdf2", "hht"}) {
    const auto end = [&](double solve_tolerance) {
      return run(method_named(method), p, 1,
                 {.step_size = 0.02, .solve_tolerance = solve_tolerance})
          .state;
    };
    const State exact = end(tight);
    const auto part = [&](double solve_tolerance) {
      return distance(end(solve_tolerance), exact) / distance(exact, truth);
    };
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
      BOOST_TEST_CONTEXT(method << " at " << tolerance) {
        // The error of predictions is of the size of the steps' errors, up to a small factor.
        BOOST_TEST(part(tolerance) < 5 * tolerance);
        BOOST_TEST(part(tolerance) > 0.1 * tolerance);
      }
    }
    BOOST_TEST(part(0) == part(1e-4));
  }
}

BOOST_AUTO_TEST_SUITE_END()
