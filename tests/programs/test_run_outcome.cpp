#include <boost/test/unit_test.hpp>

#include "experiments/stability_map/run_outcome.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/settle.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(run_outcome)

using namespace qddot;
using namespace qddot::stability_map;

namespace {

struct Case {
  Scene drawn;
  Model scene{drawn};
  double rest_energy = [this] {
    const Model rest(settled(drawn, drawn.name), Reductions::only({Reduction::pins}));
    return rest.potential(rest.initial());
  }();

  Case(const char* generator, const GeneratorValues& values)
      : drawn(generate(*find_generator(generator), values, generator)) {}
  RunOutcome operator()(const char* method, double h, double until, int iterations = 0) const {
    return stability_map::run_outcome(method_named(method),
                                      {.step_size = h, .iterations = iterations}, scene,
                                      {.rest_energy = rest_energy, .until = until, .seconds = 60});
  }
};

// w = sqrt(k/m) = 5 rad/s.
const Case& oscillator() {
  static const Case one("oscillator", {{"mass", 2}, {"stiffness", 50}});
  return one;
}
constexpr double w = 5;

// A swing of 2 s on a spring of 100 times that frequency.
const Case& stiff_pendulum() {
  static const Case one("pendulum", {{"stiffness", 1e5}});
  return one;
}

}  // namespace

BOOST_AUTO_TEST_CASE(symplectic_methods_are_bounded_below_their_limit_and_diverge_above) {
  for (const char* method : {"symplectic_euler", "verlet", "position_verlet"}) {
    BOOST_TEST_CONTEXT(method) {
      BOOST_TEST(oscillator()(method, 0.999 * 2 / w, 2000).outcome == "bounded");
      const RunOutcome above = oscillator()(method, 1.001 * 2 / w, 2000);
      BOOST_TEST(above.outcome == "diverged");
      // ln rho / h with rho = 1 + 2 sqrt(2 * 0.001) + ..., by theory; the fit sees its start too.
      const double rho = linear_step(method_named(method), 2.002).spectral_radius();
      BOOST_TEST(above.growth_rate == std::log(rho) / (2.002 / w),
                 boost::test_tools::tolerance(0.02));
    }
  }
}

BOOST_AUTO_TEST_CASE(
    a_stable_methods_fail_on_a_stiff_pendulum_that_linear_theory_knows_nothing_of) {
  // h w = 16 for the spring, 33 steps a swing: bounded, as linear theory has it.
  for (const char* method : {"implicit_midpoint", "trapezoidal", "discrete_gradient"}) {
    BOOST_TEST(stiff_pendulum()(method, 0.05, 20).outcome == "bounded", method);
  }
  // h w = 19: the energy grows more than a thousandfold.
  for (const char* method : {"implicit_midpoint", "trapezoidal"}) {
    const RunOutcome result = stiff_pendulum()(method, 0.06, 20);
    BOOST_TEST(result.energy_max > 1000, method);
    BOOST_TEST((result.outcome == "gained" || result.outcome == "diverged"), method);
  }
  // The discrete gradient's equations have no solution that Newton finds there, but what it has
  // taken of steps has kept the energy, to what its solves leave.
  const RunOutcome kept = stiff_pendulum()("discrete_gradient", 0.06, 20);
  BOOST_TEST(kept.outcome == "newton_failed");
  BOOST_TEST(kept.energy_max < 1 + 1e-6);
}

BOOST_AUTO_TEST_CASE(linearly_implicit_steps_fail_where_a_strut_makes_their_matrix_singular) {
  // One free node between two pins: lambda = (2 k/m)(l0/l - 1), less by the bend's part in 1e5.
  const double k = 1000, m = 0.1, compression = 0.8;
  const double rate = std::sqrt(2 * k / m * (1 / compression - 1));
  const Case strut(
      "strut",
      {{"nodes", 3}, {"stiffness", k}, {"mass", m}, {"compression", compression}, {"bend", 1e-3}});
  const auto at = [&](double h_squared_lambda) {
    return strut("semi_implicit_euler", std::sqrt(h_squared_lambda) / rate, 1);
  };
  BOOST_TEST(at(0.5).outcome != "indefinite_matrix");
  BOOST_TEST(at(0.5).energy_max < 10);
  BOOST_TEST(at(1.0).outcome == "indefinite_matrix");
  BOOST_TEST(at(1.0).energy_max > 1e4);
  // Its map damps the sideways motion beyond h rate = 2, by 1/(1 - h rate) a step. It stands still
  // on top, which is bounded and wrong.
  BOOST_TEST(at(5).outcome == "bounded");
  BOOST_TEST(std::abs(at(5).energy_end - 1) < 1e-3);
  // Implicit Euler solves the same equation to the end, at a minimum.
  const RunOutcome solved = strut("implicit_euler", 1 / rate, 1);
  BOOST_TEST(solved.energy_max < 1 + 1e-6);
}

BOOST_AUTO_TEST_CASE(few_iterations_converge_to_another_motion) {
  const Case chain("chain", {{"nodes", 40}, {"stiffness", 1e5}});
  BOOST_TEST(chain("local_global", 0.02, 0.5, 1).outcome == "unconverged");
  BOOST_TEST(chain("local_global", 1e-4, 0.02, 10).outcome != "unconverged");
}

BOOST_AUTO_TEST_SUITE_END()
