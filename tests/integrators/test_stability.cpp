#include <boost/test/unit_test.hpp>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "tests/integrators/faulty_verlet.hpp"

BOOST_AUTO_TEST_SUITE(stability)

using namespace qddot;

namespace {

const Oscillator oscillator;
const double w = oscillator.omega();

State run_oscillator(const Method& method, double h, int steps) {
  const Problem p = oscillator.problem();
  const auto system = make_mass_spring(p.network);
  const Run r = run(method, *system, p.initial, steps * h, {.step_size = h});
  BOOST_REQUIRE(r.summary.message == "");
  return r.state;
}

State run_oscillator(const char* method, double h, int steps) {
  return run_oscillator(method_named(method), h, steps);
}

// sqrt(w^2 x^2 + v^2), constant in the exact motion.
double amplitude(const State& s) { return std::hypot(w * s.q[0], s.v[0]); }

double growth_a_step(const char* method, double hw, int steps) {
  const double ratio =
      amplitude(run_oscillator(method, hw / w, steps)) / amplitude(oscillator.problem().initial);
  return std::pow(ratio, 1.0 / steps);
}

// The quadratic form v^2 + b x v + c x^2 that a method conserves on the oscillator up to rounding.
struct Invariant {
  const char* method;
  double b, c;
  double operator()(const State& s) const {
    const double x = s.q[0], v = s.v[0];
    return v * v + b * x * v + c * x * x;
  }
};

// Kick then drift conserves v^2 - h w^2 x v + w^2 x^2, and kick drift kick v^2 + w^2 (1 - h^2
// w^2/4) x^2. Both are positive definite, and the motion is bounded, exactly if h w < 2.
std::vector<Invariant> invariants(double h) {
  return {{"symplectic_euler", -h * w * w, w * w}, {"verlet", 0, w * w * (1 - h * h * w * w / 4)}};
}

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

// The momentum of the scene `pair`, then the angular momentum about the origin.
Vec momenta(const System& system, const State& s) {
  Vec both = Vec::Zero(6);
  for (Index i = 0; i < system.size(); i += 3) {
    const Eigen::Vector3d x = s.q.segment<3>(i), p = system.mass()[i] * s.v.segment<3>(i);
    both.head<3>() += p;
    both.tail<3>() += x.cross(p);
  }
  return both;
}

// The change of the momenta in 1000 steps of 1/100 s.
Vec change_of_momenta(const Method& method) {
  const ReducedScene scene(generate(*find_generator("pair"), {}, "pair"),
                           Reductions::only({Reduction::pins}));
  State start = scene.initial();
  for (Index i = 0; i < 6; ++i) start.v[i] += Eigen::Vector3d(1, -2, 3)[i % 3];  // adrift
  const Run r = run(method, scene.system(), start, 10, {.step_size = 0.01});
  BOOST_REQUIRE(r.summary.message == "");
  return momenta(scene.system(), r.state) - momenta(scene.system(), start);
}

}  // namespace

BOOST_AUTO_TEST_CASE(explicit_euler_grows_by_its_factor_at_every_step_size) {
  for (const double hw : {0.01, 0.3, 1.0, 3.0}) {
    // 50 steps round 50 times; the root divides that by 50.
    BOOST_TEST(std::abs(growth_a_step("explicit_euler", hw, 50) / std::hypot(1, hw) - 1) < 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(implicit_and_semi_implicit_euler_decay_by_its_inverse_at_every_step_size) {
  for (const char* method : {"implicit_euler", "semi_implicit_euler"}) {
    for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
      const double growth = growth_a_step(method, hw, 50);
      // A step cancels all but 1/(h w) of the amplitude, and with it as many digits.
      BOOST_TEST(std::abs(growth * std::hypot(1, hw) - 1) < 1e-15 * (1 + hw));
    }
  }
}

BOOST_AUTO_TEST_CASE(semi_implicit_euler_is_implicit_euler_where_f_is_linear) {
  for (const double hw : {0.1, 2.0}) {
    const State a = run_oscillator("implicit_euler", hw / w, 20);
    const State b = run_oscillator("semi_implicit_euler", hw / w, 20);
    // Rounding of 20 steps of numbers of about 1.
    BOOST_TEST(distance(a, b) < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(symplectic_euler_and_verlet_keep_their_quadratic_form_up_to_the_limit) {
  const State start = oscillator.problem().initial;
  for (const double hw : {0.1, 1.0, 0.999 * 2}) {
    const double h = hw / w;
    for (const Invariant& form : invariants(h)) {
      BOOST_TEST_CONTEXT(form.method << " at h w = " << hw) {
        const int steps = 100000;
        const State end = run_oscillator(form.method, h, steps);
        // Each step rounds by 1e-16 of v^2 + w^2 x^2, at most 1000 times the form near the limit;
        // over 1e5 steps that adds up to 1e-8 at the very worst.
        BOOST_TEST(std::abs(form(end) / form(start) - 1) < 1e-8);
        BOOST_TEST(amplitude(end) < 60 * amplitude(start));  // 2 / sqrt(1 - 0.999^2) = 45
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(symplectic_euler_and_verlet_grow_by_their_factor_beyond_the_limit) {
  // Both have the characteristic polynomial z^2 - (2 - h^2 w^2) z + 1.
  const double hw = 1.001 * 2, half_trace = 1 - hw * hw / 2;
  const double factor = std::abs(half_trace) + std::sqrt(half_trace * half_trace - 1);
  for (const char* method : {"symplectic_euler", "verlet"}) {
    // The ratio of two late amplitudes: the start's part of the other mode is gone.
    const double ratio = amplitude(run_oscillator(method, hw / w, 400)) /
                         amplitude(run_oscillator(method, hw / w, 300));
    BOOST_TEST(std::abs(std::pow(ratio, 0.01) / factor - 1) < 1e-12);
  }
}

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

BOOST_AUTO_TEST_CASE(every_fixed_step_method_keeps_the_momentum_of_free_masses) {
  for (const Method& method : methods_of(Knob::step_size)) {
    BOOST_TEST_CONTEXT(method.name) {
      // The forces of a spring cancel to the last bit. 1000 steps round p of 10 kg m/s; the linear
      // solves of implicit methods round a few times more.
      BOOST_TEST(change_of_momenta(method).head<3>().norm() < 1e-11);
    }
  }
}

BOOST_AUTO_TEST_CASE(symplectic_methods_and_the_linear_midpoint_keep_angular_momentum) {
  for (const Method& method : methods_of(Knob::step_size)) {
    if (!keeps_angular_momentum(method)) continue;
    BOOST_TEST_CONTEXT(method.name) {
      // Rounding as above, of x p of 100 kg m^2/s after a flight of 30 m, but for what the
      // nonlinear solves of implicit symplectic methods leave.
      const bool iterates = method.is(Trait::symplectic) && method.is(Trait::implicit);
      BOOST_TEST(change_of_momenta(method).tail<3>().norm() < (iterates ? 1e-6 : 1e-10));
    }
  }
}

BOOST_AUTO_TEST_CASE(other_methods_lose_angular_momentum) {
  for (const char* method : {"explicit_euler", "implicit_euler", "semi_implicit_euler"}) {
    BOOST_TEST(change_of_momenta(method_named(method)).tail<3>().norm() > 1e-2);
  }
}

BOOST_AUTO_TEST_SUITE_END()
