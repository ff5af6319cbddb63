#include <boost/test/unit_test.hpp>

#include "tests/integrators/faulty_verlet.hpp"

BOOST_AUTO_TEST_SUITE(stability)

using namespace qddot;

namespace {

constexpr int masses = 12;
constexpr double mass = 0.3, stiffness = 200;
const double w_max = 2 * std::sqrt(stiffness / mass) * std::sin(masses * M_PI / (2 * (masses + 1)));

// A linear chain, out of its rest so that all modes move, the highest most.
Run run_chain(const char* method, double h, int steps) {
  const auto system = make_mass_spring(linear_chain(masses, mass, stiffness));
  State state{0, Vec::LinSpaced(masses, 1, masses), Vec::Zero(masses)};
  for (int i = 0; i < masses; ++i)
    state.q[i] += 0.1 * std::sin((i + 1) * masses * M_PI / (masses + 1));
  state.v[2] = 1;
  return run(method_named(method), *system, state, steps * h, {.step_size = h});
}

// The energies 1/2 m (y_j'^2 + w_j^2 y_j^2) of the chain's modes sin(j i pi/(N + 1)) about where it
// rests, the quadratic invariants of its motion.
Vec modal_energies(const State& s) {
  const State rest = State{0, Vec::LinSpaced(masses, 1, masses), Vec::Zero(masses)};
  Vec energies(masses);
  for (int j = 1; j <= masses; ++j) {
    const double angle = j * M_PI / (masses + 1);
    const double omega = 2 * std::sqrt(stiffness / mass) * std::sin(angle / 2);
    double y = 0, v = 0;
    for (int i = 0; i < masses; ++i) {
      const double shape = std::sqrt(2. / (masses + 1)) * std::sin((i + 1) * angle);
      y += shape * (s.q[i] - rest.q[i]);
      v += shape * s.v[i];
    }
    energies[j - 1] = mass / 2 * (v * v + omega * omega * y * y);
  }
  return energies;
}

// The distance from its start at which a run forward, and back with reversed velocities, ends.
double return_distance(const Method& method) {
  const Problem p = hammock(3);
  const auto system = make_mass_spring(p.network);
  const double h = 0.02;
  State state = p.initial;
  for (int i = 0; i < 2; ++i) {
    state = run(method, *system, {0, state.q, state.v}, 200 * h, {.step_size = h}).state;
    state.v = -state.v;
  }
  return distance(state, p.initial);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_linear_chain_stays_bounded_below_the_limit_and_explodes_above) {
  for (const char* method : {"symplectic_euler", "verlet"}) {
    const Run below = run_chain(method, 0.999 * 2 / w_max, 20000);
    BOOST_TEST(below.summary.message == "");
    // The modes' speeds at most 1 / sqrt(1 - 0.999^2) = 22.4 times those of the exact motion, which
    // are at most sqrt(2 E/m) = 13.1 m/s together.
    BOOST_TEST(below.state.v.norm() < 22.4 * 13.2);

    const Run above = run_chain(method, 1.001 * 2 / w_max, 20000);
    BOOST_TEST(name(above.summary.outcome) == "diverged");
  }
}

BOOST_AUTO_TEST_CASE(implicit_midpoint_keeps_the_energy_of_each_mode_of_a_linear_chain) {
  const int steps = 10000;
  const double h = 3 / w_max;
  const Vec start = modal_energies(run_chain("implicit_midpoint", h, 0).state);
  const auto lost = [&](const char* method) {
    const Run r = run_chain(method, h, steps);
    BOOST_REQUIRE(r.summary.message == "");
    return (modal_energies(r.state) - start).cwiseAbs().maxCoeff() / start.maxCoeff();
  };
  // Rounding of 1e4 steps on positions of 13 m, 1e-15 each against displacements of 0.1 m, all one
  // way at the worst.
  BOOST_TEST(lost("implicit_midpoint") < 1e-9);
  BOOST_TEST(lost("trapezoidal") <
             1e-9);  // which is conjugate to it, and the same where f is linear
  BOOST_TEST(lost("generalized_alpha") > 0.5);
}

BOOST_AUTO_TEST_CASE(reversible_methods_run_backwards_to_their_start) {
  for (const char* method : {"verlet", "position_verlet", "blanes_moan4", "blanes_moan6",
                             "kahan_li8", "linear_midpoint", "linear_midpoint4"}) {
    // 400 steps (of up to 17 substeps) on numbers of 10, each rounding by 1e-15, which the motion
    // may enlarge some ten times.
    BOOST_TEST(return_distance(method_named(method)) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(methods_that_are_not_reversible_do_not_return) {
  // First order misses by about h, a thousandth of a kick by some 1e-4: all far above rounding.
  for (const char* method : {"symplectic_euler", "implicit_euler"}) {
    BOOST_TEST(return_distance(method_named(method)) > 1e-3);
  }
  BOOST_TEST(return_distance(method_named("rk4")) > 1e-5);
  BOOST_TEST(return_distance(faulty_verlet<1>()) > 1e-5);
}

BOOST_AUTO_TEST_SUITE_END()
