#include <complex>
#include <functional>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

using namespace qddot;

BOOST_AUTO_TEST_SUITE(implicit_methods)

namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXd;

// Of x'' = -w^2 x with h = 1: state (x, h v) or more, and the matrix that a step multiplies it by.
using Amplification = std::function<MatrixXd(double hw)>;

// The step of a method that is a rational function of z = h J, J = [[0, 1], [-(h w)^2, 0]].
Amplification rational(const std::function<MatrixXd(const MatrixXd& z)>& r) {
  return [r](double hw) { return r(MatrixXd{{0, 1}, {-hw * hw, 0}}); };
}
const MatrixXd one = MatrixXd::Identity(2, 2);

// Unknowns (x', v', a') from (x, v, a), by the equations as they stand in the paper.
MatrixXd by_alphas(double hw, double alpha_m, double alpha_f) {
  const double gamma = 0.5 - alpha_m + alpha_f, beta = std::pow(1 - alpha_m + alpha_f, 2) / 4;
  const double w2 = hw * hw;
  const MatrixXd next{{1, 0, -beta}, {0, 1, -gamma}, {(1 - alpha_f) * w2, 0, 1 - alpha_m}};
  const MatrixXd last{{1, 1, 0.5 - beta}, {0, 1, 1 - gamma}, {-alpha_f * w2, 0, -alpha_m}};
  return next.inverse() * last;
}
MatrixXd chung_hulbert(double hw, double rho) {
  return by_alphas(hw, (2 * rho - 1) / (rho + 1), rho / (rho + 1));
}
MatrixXd hilber_hughes_taylor(double hw, double rho) {
  return by_alphas(hw, 0, (1 - rho) / (1 + rho));
}

const double g = 2 - std::sqrt(2.0);

struct Formula {
  const char* method;
  Amplification matrix;
};
// Of one-step methods; an acceleration is carried along as a third number where there is one.
const Formula formulas[] = {
    {"implicit_euler", rational([](const MatrixXd& z) { return (one - z).inverse(); })},
    {"implicit_midpoint",
     rational([](const MatrixXd& z) { return (one - z / 2).inverse() * (one + z / 2); })},
    {"trapezoidal",
     rational([](const MatrixXd& z) { return (one - z / 2).inverse() * (one + z / 2); })},
    {"discrete_gradient",
     rational([](const MatrixXd& z) { return (one - z / 2).inverse() * (one + z / 2); })},
    {"generalized_alpha", [](double hw) { return chung_hulbert(hw, 0.8); }},
    {"hht", [](double hw) { return hilber_hughes_taylor(hw, 0.8); }},
    {"trbdf2", rational([](const MatrixXd& z) {
       const MatrixXd middle = (one - g / 2 * z).inverse() * (one + g / 2 * z);
       return MatrixXd((one - (1 - g) / (2 - g) * z).inverse() *
                       (middle - (1 - g) * (1 - g) * one) / (g * (2 - g)));
     })}};

const Oscillator oscillator;
const double w = oscillator.omega();

// (x, h v), scaled so that both are of a size.
Vec scaled(const State& s, double h) { return Vec{{s.q[0], h * s.v[0]}}; }

State run_oscillator(const char* method, double h, double t_end) {
  const Problem p = oscillator.problem();
  const auto system = make_mass_spring(p.network);
  const Run r = run(method_named(method), *system, p.initial, t_end, {.step_size = h});
  BOOST_REQUIRE(r.summary.message == "");
  return r.state;
}

// How far the method is from the power of its matrix after so many steps, relative to the start.
double defect(const char* method, const Amplification& matrix, double hw, int steps) {
  const double h = hw / w;
  const MatrixXd a = matrix(hw);
  Vec y = scaled(oscillator.problem().initial, h);
  if (a.rows() == 3) {  // h^2 a
    y.conservativeResize(3);
    y[2] = -hw * hw * y[0];
  }
  const double start = y.head<2>().norm();
  for (int i = 0; i < steps; ++i) y = a * y;
  return distance(scaled(run_oscillator(method, h, steps * h), h), y.head<2>()) / start;
}

// Rounding of up to 100 steps; at h w = 100 a step cancels hw^2 times what it leaves.
double rounding(double hw) { return 1e-13 * (1 + hw * hw); }

double spectral_radius(const MatrixXd& a) { return a.eigenvalues().cwiseAbs().maxCoeff(); }

// BDF2 from its definition, the first step one of implicit Euler and the last one shorter.
Vec bdf2_by_hand(double hw, int steps, double last_part) {
  const MatrixXd z{{0, 1}, {-hw * hw, 0}};
  Vec last = scaled(oscillator.problem().initial, hw / w);
  Vec now = (one - z).inverse() * last;
  for (int i = 1; i < steps; ++i) {
    const Vec next = (1.5 * one - z).inverse() * (2 * now - 0.5 * last);
    last = now;
    now = next;
  }
  // The derivative at the end of the parabola through times -1, 0 and p.
  const double p = last_part;
  const double c_next = (1 + 2 * p) / (p * (1 + p)), c_now = -(1 + p) / p, c_last = p / (1 + p);
  return (c_next * one - z).inverse() * (-c_now * now - c_last * last);
}

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
  e.system.mean_force(e.a.q, e.b.q, f);
  return std::max(distance(e.b.v, e.a.v + e.h * f.cwiseQuotient(e.system.mass())),
                  distance(e.b.q, e.a.q + e.h / 2 * (e.a.v + e.b.v)));
}
// With a_n = M^-1 f(q_n) to begin with.
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

BOOST_AUTO_TEST_CASE(steps_multiply_the_oscillator_by_the_method_s_own_matrix) {
  for (const auto& [method, matrix] : formulas) {
    for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
      for (const int steps : {1, 100}) {
        BOOST_TEST_CONTEXT(method << " at h w = " << hw << ", " << steps << " steps") {
          BOOST_TEST(defect(method, matrix, hw, steps) < rounding(hw));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(another_step_or_another_matrix_is_noticed) {
  for (const auto& [method, matrix] : formulas) {
    const Amplification longer = [&](double hw) { return matrix(1.0001 * hw); };
    BOOST_TEST(defect(method, longer, 0.3, 10) > 100 * rounding(0.3));
  }
  BOOST_TEST(defect("hht", formulas[4].matrix, 0.3, 10) > 100 * rounding(0.3));
  BOOST_TEST(defect("trbdf2", formulas[1].matrix, 0.3, 10) > 100 * rounding(0.3));
}

BOOST_AUTO_TEST_CASE(bdf2_is_its_definition_also_over_a_shorter_last_step) {
  for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
    for (const double part : {1.0, 0.4}) {
      const double h = hw / w;
      const State end = run_oscillator("bdf2", h, (20 + part) * h);
      BOOST_TEST_CONTEXT("h w = " << hw << ", last " << part) {
        BOOST_TEST(distance(scaled(end, h), bdf2_by_hand(hw, 20, part)) < rounding(hw));
        if (hw <= 1) {  // beyond, nothing is left of the motion
          BOOST_TEST(distance(scaled(end, h), bdf2_by_hand(hw, 20, 0.9 * part)) >
                     10 * rounding(hw));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(no_matrix_grows_at_any_step_and_the_alphas_damp_as_asked) {
  for (const auto& [method, matrix] : formulas) {
    for (double hw = 1e-2; hw < 1e4; hw *= 1.5) {
      BOOST_TEST_CONTEXT(method << " at h w = " << hw) {
        BOOST_TEST(spectral_radius(matrix(hw)) < 1 + 1e-9);
      }
    }
  }
  for (const double rho : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    // A double root where rho is the radius: rounding enters by its square root.
    BOOST_TEST(std::abs(spectral_radius(chung_hulbert(1e6, rho)) - rho) < 1e-3);
    if (rho >= 0.5) {
      BOOST_TEST(std::abs(spectral_radius(hilber_hughes_taylor(1e6, rho)) - rho) < 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_spectral_radius_asked_for_is_the_one_that_is_had) {
  const Problem p = oscillator.problem();
  const auto system = make_mass_spring(p.network);
  const double hw = 2, h = hw / w;
  for (const char* method : {"generalized_alpha", "hht"}) {
    for (const double rho : {0.5, 0.7, 1.0}) {
      const Run r = run(method_named(method), *system, p.initial, 50 * h,
                        {.step_size = h, .spectral_radius = rho});
      const MatrixXd a =
          method == std::string("hht") ? hilber_hughes_taylor(hw, rho) : chung_hulbert(hw, rho);
      Vec y = scaled(p.initial, h);
      y.conservativeResize(3);
      y[2] = -hw * hw * y[0];
      for (int i = 0; i < 50; ++i) y = a * y;
      BOOST_TEST(distance(scaled(r.state, h), y.head<2>()) < rounding(hw));
    }
  }
}

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
          const Knobs knobs{.step_size = h, .solve_tolerance = tight};
          const double t_end = 100.4 * h;
          const Run a = run(method_named(ours), *system, p.initial, t_end, knobs);
          const Run b = run(method_named(theirs), *system, p.initial, t_end, knobs);
          BOOST_TEST(a.summary.message == "");
          // ARKODE's iteration leaves a tenth of 1e-10 a stage, of 101 steps.
          BOOST_TEST(distance(a.state, b.state) < 1e-8);
          const Run c = run(method_named("trapezoidal"), *system, p.initial, t_end, knobs);
          if (!system->stiffness_is_constant()) BOOST_TEST(distance(c.state, b.state) > 1e-5);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_discrete_gradient_keeps_energy_and_momenta_at_large_steps_others_do_not) {
  // h w is about 1; energies of 50 J, 1000 steps that each round some 1e-15 of it and leave 1e-9 of
  // what their predictions were wrong by, up to 0.05 m or 1 m/s of masses of 2 kg at 3 m/s.
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
        // What predictions miss is of the size of the steps' errors, within a small factor.
        BOOST_TEST(part(tolerance) < 5 * tolerance);
        BOOST_TEST(part(tolerance) > 0.1 * tolerance);
      }
    }
    BOOST_TEST(part(0) == part(1e-4));
  }
}

BOOST_AUTO_TEST_SUITE_END()
