#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(implicit_methods)

using namespace qddot;

namespace {

// Residuals of a step on a nonlinear scene, by the equations of each method as they are written.
struct Ends {
  const System& system;
  State a, b;
  double h;
  Vec acceleration(const Vec& q) const { return force_at(system, q).cwiseQuotient(system.mass()); }
};
double midpoint_residual(const Ends& e) {
  const Vec middle = (e.a.q + e.b.q) / 2;
  return std::max(distance(e.b.v, e.a.v + e.h * e.acceleration(middle)),
                  distance(e.b.q, e.a.q + e.h / 2 * (e.a.v + e.b.v)));
}
double trapezoidal_residual(const Ends& e) {
  const Vec mean = (e.acceleration(e.a.q) + e.acceleration(e.b.q)) / 2;
  return std::max(distance(e.b.v, e.a.v + e.h * mean),
                  distance(e.b.q, e.a.q + e.h / 2 * (e.a.v + e.b.v)));
}
double discrete_gradient_residual(const Ends& e) {
  Vec f(e.system.size());
  offered<DiscreteGradient>(e.system).discrete_gradient(e.a.q, e.b.q, f);
  return std::max(distance(e.b.v, e.a.v + e.h * f.cwiseQuotient(e.system.mass())),
                  distance(e.b.q, e.a.q + e.h / 2 * (e.a.v + e.b.v)));
}
// The method begins with a_n = M^-1 f(q_n).
double generalized_alpha_residual(const Ends& e, double rho) {
  const double m = (2 * rho - 1) / (rho + 1), f = rho / (rho + 1);
  const double gamma = 0.5 - m + f, beta = std::pow(1 - m + f, 2) / 4;
  const Vec a0 = e.acceleration(e.a.q);
  const Vec a1 = (e.acceleration((1 - f) * e.b.q + f * e.a.q) - m * a0) / (1 - m);
  return std::max(
      distance(e.b.v, e.a.v + e.h * ((1 - gamma) * a0 + gamma * a1)),
      distance(e.b.q, e.a.q + e.h * e.a.v + e.h * e.h * ((0.5 - beta) * a0 + beta * a1)));
}

struct Equation {
  const char* method;
  std::function<double(const Ends&)> residual;
};
const Equation equations[] = {
    {"implicit_midpoint", midpoint_residual},
    {"trapezoidal", trapezoidal_residual},
    {"discrete_gradient", discrete_gradient_residual},
    {"generalized_alpha", [](const Ends& e) { return generalized_alpha_residual(e, 0.8); }}};

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

Eigen::Matrix<double, 6, 1> momenta(const System& system, const State& s) {
  Eigen::Matrix<double, 6, 1> both = Eigen::Matrix<double, 6, 1>::Zero();
  for (Index i = 0; i < system.size(); i += 3) {
    const Eigen::Vector3d x = s.q.segment<3>(i), p = system.mass()[i] * s.v.segment<3>(i);
    both.head<3>() += p;
    both.tail<3>() += x.cross(p);
  }
  return both;
}

struct Change {
  double energy, momenta;
};
Change change(const char* method, double h, int steps, double solve_tolerance = 0) {
  const Problem p = tumbling();
  const auto system = make_mass_spring(p.network);
  const Run r = run(method_named(method), *system, p.initial, steps * h,
                    {.step_size = h, .solve_tolerance = solve_tolerance});
  BOOST_REQUIRE(r.summary.message == "");
  return {std::abs(total_energy(*system, r.state) - total_energy(*system, p.initial)),
          distance(momenta(*system, r.state), momenta(*system, p.initial))};
}

constexpr double tight = 1e-13;  // a solve_tolerance that only rounding ends

}  // namespace

BOOST_AUTO_TEST_CASE(hht_without_damping_is_the_trapezoidal_rule) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  const Run newmark = run(method_named("trapezoidal"), *system, p.initial, 1, {.step_size = 0.02});
  const Run hht =
      run(method_named("hht"), *system, p.initial, 1, {.step_size = 0.02, .spectral_radius = 1});
  // The same equations, and so the same iterations but for rounding.
  BOOST_TEST(distance(newmark.state, hht.state) < 1e-11);
  BOOST_TEST(newmark.summary.counts == hht.summary.counts);
}

BOOST_AUTO_TEST_CASE(a_step_on_a_nonlinear_scene_solves_the_method_s_equations_and_no_others) {
  for (const int dimension : {2, 3}) {
    const Problem p = hammock(dimension);
    const auto system = make_mass_spring(p.network);
    const double h = 0.05;
    for (const auto& [method, residual] : equations) {
      const Run r = run(method_named(method), *system, p.initial, h,
                        {.step_size = h, .solve_tolerance = tight});
      BOOST_REQUIRE(r.summary.message == "");
      for (const auto& [other, its_residual] : equations) {
        BOOST_TEST_CONTEXT(method << " in the equations of " << other) {
          const double left = its_residual({*system, p.initial, r.state, h});
          // Positions of 5 m round by 1e-15, which times 4/h is a velocity.
          BOOST_TEST((method == other ? left < 1e-12 : left > 1e-5));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(midpoint_and_trbdf2_by_arkode_are_the_hand_written_ones) {
  for (const auto& [ours, theirs] : {std::pair{"implicit_midpoint", "arkode_implicit_midpoint"},
                                     std::pair{"trbdf2", "arkode_trbdf2"}}) {
    for (const Problem& p : {linear_hammock(2), hammock(2), hammock(3)}) {
      const auto system = make_mass_spring(p.network);
      for (const double h : {0.01, 0.05}) {
        BOOST_TEST_CONTEXT(ours << " at h = " << h) {
          const Options options{.step_size = h, .solve_tolerance = tight};
          const double t_end = 100.4 * h;
          const Run a = run(method_named(ours), *system, p.initial, t_end, options);
          const Run b = run(method_named(theirs), *system, p.initial, t_end, options);
          BOOST_TEST(a.summary.message == "");
          // ARKODE's iteration leaves a tenth of 1e-10 a stage, of 101 steps.
          BOOST_TEST(distance(a.state, b.state) < 1e-8);
          const Run c = run(method_named("trapezoidal"), *system, p.initial, t_end, options);
          if (!system->stiffness_is_constant()) BOOST_TEST(distance(c.state, b.state) > 1e-5);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_discrete_gradient_keeps_energy_and_momenta_at_large_steps_others_do_not) {
  // h w is about 1 and the energy 50 J. Each of 1000 steps rounds some 1e-15 of it and leaves 1e-9
  // of the error of its prediction. That error is up to 0.05 m or 1 m/s, with masses of 2 kg at 3
  // m/s.
  const Change kept = change("discrete_gradient", 0.05, 1000);
  BOOST_TEST(kept.energy < 5e-6);
  BOOST_TEST(kept.momenta < 5e-6);
  const Change exact = change("discrete_gradient", 0.05, 1000, tight);
  BOOST_TEST(exact.energy < 1e-9);
  BOOST_TEST(exact.momenta < 1e-9);
  for (const char* method : {"trapezoidal", "implicit_midpoint", "bdf2", "generalized_alpha"}) {
    BOOST_TEST(change(method, 0.05, 1000, tight).energy > 1e-2);
  }
  // Midpoint keeps the angular momentum, the trapezoidal rule another one nearby.
  BOOST_TEST(change("implicit_midpoint", 0.05, 1000, tight).momenta < 1e-9);
  BOOST_TEST(change("trapezoidal", 0.05, 1000, tight).momenta > 1e-4);
}

BOOST_AUTO_TEST_CASE(where_k_is_constant_each_stage_is_one_solve_and_a_run_one_factorisation) {
  const Problem p = linear_hammock(2);
  const auto system = make_mass_spring(p.network);
  struct {
    const char* method;
    int stages, to_begin, factorizations;
  } const cases[] = {{"implicit_euler", 1, 0, 1},
                     {"implicit_midpoint", 1, 1, 1},
                     {"trapezoidal", 1, 1, 1},
                     {"generalized_alpha", 1, 1, 1},
                     {"hht", 1, 1, 1},
                     {"trbdf2", 2, 1, 1},
                     {"discrete_gradient", 1, 1, 1},
                     {"bdf2", 1, 0, 2}};  // its first step's c is 1
  for (const auto& [method, stages, to_begin, factorizations] : cases) {
    BOOST_TEST_CONTEXT(method) {
      constexpr std::int64_t steps = 37;
      const Run r =
          run(method_named(method), *system, p.initial, steps * 0.01, {.step_size = 0.01});
      BOOST_TEST(r.summary.counts == (Counts{.steps = steps,
                                             .force_evaluations = stages * steps + to_begin,
                                             .stiffness_evaluations = factorizations,
                                             .factorizations = factorizations,
                                             .solves = stages * steps,
                                             .newton_iterations = stages * steps}));
    }
  }
}

BOOST_AUTO_TEST_CASE(where_k_changes_a_force_and_a_solve_an_iteration_and_few_factorisations) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  for (const char* method : {"implicit_euler", "implicit_midpoint", "trapezoidal", "bdf2", "hht",
                             "generalized_alpha", "trbdf2", "discrete_gradient"}) {
    BOOST_TEST_CONTEXT(method) {
      const Counts c =
          run(method_named(method), *system, p.initial, 1, {.step_size = 0.01}).summary.counts;
      const bool begins_with_a_force =
          method != std::string("implicit_euler") && method != std::string("bdf2");
      BOOST_TEST(c.steps == 100);
      BOOST_TEST(c.solves == c.newton_iterations);
      BOOST_TEST(c.stiffness_evaluations == c.factorizations);
      // A solve whose correction shrinks too slowly is made again with new factors, at the same u.
      BOOST_TEST(c.force_evaluations - begins_with_a_force <= c.newton_iterations);
      BOOST_TEST(c.force_evaluations - begins_with_a_force >=
                 c.newton_iterations - c.factorizations);
      BOOST_TEST(c.factorizations < c.steps / 4);  // not one a step
    }
  }
}

BOOST_AUTO_TEST_CASE(what_solves_leave_is_their_tolerance_of_the_method_s_own_error) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  const State truth =
      run(method_named("kahan_li8"), *system, p.initial, 1, {.step_size = 0.002}).state;
  for (const char* method : {"implicit_euler", "trapezoidal", "bdf2", "trbdf2", "hht"}) {
    const auto end = [&](double solve_tolerance) {
      return run(method_named(method), *system, p.initial, 1,
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
