#include <iomanip>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/measure/stability/diagnosis.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(linear_step)

using namespace qddot;

namespace {

using Complex = std::complex<double>;

// Velocity Verlet with its second kick longer by a thousandth, a fault that the tests have to see.
class FaultyVerlet final : public Formula {
 public:
  using Formula::Formula;

  Outcome step(const State& now, double h, State& next) {
    force(now.q, f_);
    next.v = now.v + h / 2 * f_.cwiseQuotient(system().mass());
    next.q = now.q + h * next.v;
    force(next.q, f_);
    next.v += (1 + 1e-3) * h / 2 * f_.cwiseQuotient(system().mass());
    return Outcome::reached_end;
  }

  Vec f_{system().size()};
};

// Verlet's method, as the registry has it, but with these steps.
template <class Made>
Method verlet_by() {
  Method method = method_named("verlet");
  method.make = create<Made>;
  return method;
}

LinearStep step_of(const char* method, double h_omega) {
  return qddot::measure::linear_step(method_named(method), h_omega);
}

// The largest modulus of the eigenvalues of Chung and Hulbert's step of (q, h v, h^2 a).
double alpha_radius(double m, double f, double x) {
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  const Real gamma = 0.5L - m + f, beta = (1 - m + f) * (1 - m + f) / 4.0L;
  Matrix step;
  step << 1, 1, 0.5L - beta, 0, 1, 1 - gamma, 0, 0, 0;
  // (1 - m) a' + m a = -w^2 ((1 - f) q' + f q) with q' = q + h v + h^2 ((1/2 - beta) a + beta a')
  const Eigen::Matrix<Real, 1, 3> last(-1, -(1 - f), -(m / x / x + (1 - f) * (0.5L - beta)));
  step += Eigen::Matrix<Real, 3, 1>(beta, gamma, 1) * last / ((1 - m) / x / x + (1 - f) * beta);
  return static_cast<double>(Eigen::EigenSolver<Matrix>(step).eigenvalues().cwiseAbs().maxCoeff());
}

// R of y' = i w y for the methods that are a rational function of z = i h w.
struct Rational {
  std::vector<const char*> methods;
  Complex (*r)(Complex z);
};
const Rational rationals[] = {
    {{"explicit_euler"}, [](Complex z) { return 1. + z; }},
    {{"implicit_euler", "semi_implicit_euler", "local_global", "arkode_implicit_euler"},
     [](Complex z) { return 1. / (1. - z); }},
    {{"implicit_midpoint", "trapezoidal", "discrete_gradient"},
     [](Complex z) { return (2. + z) / (2. - z); }},
    {{"rk4"}, [](Complex z) { return 1. + z * (1. + z / 2. * (1. + z / 3. * (1. + z / 4.))); }}};

// Heun's method, order 2: |R(i z)|^2 = 1 + z^4/4, which grows at every h.
class Heun final : public Formula {
 public:
  using Formula::Formula;

  Outcome step(const State& now, double h, State& next) {
    Vec a(now.q.size()), b(now.q.size());
    force(now.q, a);
    force(Vec(now.q + h * now.v), b);
    next.q = now.q + h * now.v + h * h / 2 * a;
    next.v = now.v + h / 2 * (a + b);
    return Outcome::reached_end;
  }
};

// Whether a limit that the registry has is the one that steps show.
bool is_near(double declared, double measured) {
  if (declared == 0 || std::isinf(declared)) return measured == declared;
  // Bisection to 1e-12, and a radius above 1 by no more than 1e-12.
  return std::abs(measured / declared - 1) < 1e-10;
}

// bdf2 on y' = i w y has roots with 3 z^2 - 4 z + 1 = 2 i x z^2, x = h w, and their conjugates.
double bdf2_radius(double x) {
  const Complex a(3, -2 * x), root = std::sqrt(16. - 4. * a);
  return std::max(std::abs((4. + root) / (2. * a)), std::abs((4. - root) / (2. * a)));
}

}  // namespace

BOOST_AUTO_TEST_CASE(roots_are_those_of_the_method_s_rational_function) {
  for (const auto& [names, r] : rationals) {
    for (const char* name : names) {
      for (const double x : {0.01, 0.3, 1.0, 2.5, 30.0}) {
        BOOST_TEST_CONTEXT(name << " at h w = " << x) {
          const Complex expected = r({0, x});
          const LinearStep found = step_of(name, x);
          BOOST_TEST_REQUIRE(found.roots.size() == 2u);
          // Rounding of a step, enlarged by up to 1 + x by cancellation.
          const double tolerance = 1e-14 * (1 + x) * std::max(1.0, std::abs(expected));
          BOOST_TEST(std::abs(found.spectral_radius() - std::abs(expected)) < tolerance);
          BOOST_TEST(std::abs(std::abs(std::arg(found.roots[0])) - std::abs(std::arg(expected))) <
                     1e-13 * (1 + x));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(roots_of_methods_with_memory_are_all_found) {
  for (const double x : {0.1, 1.0, 10.0}) {
    const LinearStep found = step_of("bdf2", x);
    BOOST_TEST_REQUIRE(found.roots.size() == 4u);
    // Hankel matrices of condition 100 or so, and rounding of five steps.
    BOOST_TEST(std::abs(found.spectral_radius() - bdf2_radius(x)) < 1e-10);
  }
  // Chung and Hulbert: an infinitely fast vibration has the root -rho three times. A step of zero
  // has the third root (2 rho - 1)/(rho - 2) = -1/2.
  const LinearStep slow = step_of("generalized_alpha", 0.01);
  BOOST_TEST_REQUIRE(slow.roots.size() == 3u);
  BOOST_TEST(std::abs(slow.roots[2] - (-0.5)) < 1e-4);  // x^2 from the limit, and noise
}

BOOST_AUTO_TEST_CASE(stiff_steps_have_the_radius_of_their_closed_forms) {
  const double rho = 0.8;  // default of generalized_alpha and hht
  const auto sdirk2 = [](Complex z) {
    const double g = 1 - std::sqrt(0.5);
    return (1. + (1 - 2 * g) * z) / ((1. - g * z) * (1. - g * z));
  };
  for (int i = -9; i <= 24; ++i) {
    const double x = std::pow(10, i / 3.0);
    BOOST_TEST_CONTEXT("h w = " << x) {
      const auto check = [&](const char* method, double expected, double tolerance) {
        BOOST_TEST(std::abs(step_of(method, x).spectral_radius() - expected) < tolerance, method);
      };
      // Without memory, some roundings of a step.
      for (const auto& [names, r] : rationals) {
        for (const char* name : names) {
          if (method_named(name).is(Trait::implicit)) check(name, std::abs(r({0, x})), 1e-14);
        }
      }
      for (const char* name : {"trbdf2", "arkode_trbdf2", "arkode_sdirk2"})
        check(name, std::abs(sdirk2({0, x})), 1e-14);
      for (const char* name : {"linear_midpoint", "linear_midpoint4", "arkode_implicit_midpoint"})
        check(name, 1, 1e-14);
      // All roots meet at an infinite h w. Three that meet move by the cube root of the noise 1e-11
      // at which numbers remembered count no more.
      check("generalized_alpha", alpha_radius((2 * rho - 1) / (rho + 1), rho / (rho + 1), x), 3e-4);
      check("hht", alpha_radius(0, (1 - rho) / (1 + rho), x), 3e-4);
      check("bdf2", bdf2_radius(x), 3e-4);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_recurrence_made_up_is_found_again_and_noise_hides_what_is_smaller) {
  // y_n = 0.9^n (rotation by n/2), and 1e-3 (-0.4)^n beside it in one entry.
  Responses y;
  const Eigen::Matrix2d turn = 0.9 * Eigen::Rotation2Dd(0.5).toRotationMatrix();
  Eigen::Matrix2d power = Eigen::Matrix2d::Identity();
  for (int n = 0; n <= steps_observed; ++n, power *= turn) {
    y.push_back(power);
    y.back()(0, 1) += 1e-3 * (std::pow(-0.4, n) - std::pow(0.9, n) * std::cos(0.5 * n));
  }
  const auto roots = roots_of(y, 1e-11);
  BOOST_TEST_REQUIRE(roots.size() >= 3u);
  BOOST_TEST(std::abs(std::abs(roots[0]) - 0.9) < 1e-10);
  BOOST_TEST(std::abs(std::abs(std::arg(roots[0])) - 0.5) < 1e-10);
  BOOST_TEST(roots_of(y, 1e-2).size() == 2u);
}

BOOST_AUTO_TEST_CASE(damping_ratio_and_period_error_are_those_of_a_damped_vibration) {
  // A step that is an exact damped vibration, zeta = 0.1 of w' = 1.2 over h = 1.
  const double zeta = 0.1, w = 1.2;
  const Complex exponent(-zeta * w, w * std::sqrt(1 - zeta * zeta));
  const LinearStep made{.h_omega = 1, .roots = {std::exp(exponent), std::exp(std::conj(exponent))}};
  BOOST_TEST(std::abs(made.damping_ratio() - zeta) < 1e-15);
  BOOST_TEST(std::abs(made.period_error() - (1 / exponent.imag() - 1)) < 1e-15);
  // Leading orders: zeta = h w/2 with implicit Euler; Verlet's period is too short by (h w)^2/24.
  // The cosine's rounding is some 1e-16/x^2 of the period, so that a much smaller x would not do.
  const double x = 1e-2;
  BOOST_TEST(std::abs(step_of("implicit_euler", x).damping_ratio() / (x / 2) - 1) < x);
  BOOST_TEST(std::abs(step_of("verlet", x).period_error() / (-x * x / 24) - 1) < x);
  BOOST_TEST(std::abs(step_of("verlet", x).damping_ratio()) < 1e-12);  // rounding over h w
}

BOOST_AUTO_TEST_CASE(a_step_beyond_all_numbers_grows_beyond_all_bounds) {
  BOOST_TEST(std::isinf(step_of("kahan_li8", 100).spectral_radius()));
  BOOST_TEST(step_of("rk4", 100).spectral_radius() > 1e6);  // z^4/24
  BOOST_CHECK_THROW(step_of("ida", 1), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(measured_limits_are_the_declared_ones) {
  for (const Method& method : methods()) {
    if (method.asks(Need::constraints)) continue;  // see the suite `rods`
    BOOST_TEST_CONTEXT(method.name) {
      // A method without step error is stable at every h.
      const bool needs_one =
          has_linear_step(method) && !method.is(Trait::implicit) && method.order > 0;
      BOOST_TEST(method.stability_limit.has_value() == needs_one);
      if (!has_linear_step(method)) continue;
      const double measured = measured_limit(method);
      BOOST_TEST(is_near(linear_limit(method), measured),
                 "stability_limit of " << method << " is wrong or missing; measured "
                                       << std::setprecision(17) << measured);
    }
  }
  BOOST_TEST(std::isinf(linear_limit(Method{})));  // there is no default
  BOOST_TEST(std::abs(measured_limit(method_named("rk4")) - std::sqrt(8)) < 1e-10);
}

BOOST_AUTO_TEST_CASE(a_diagnosis_finds_the_limit_that_an_explicit_method_does_not_declare) {
  Method method = method_named("verlet");
  method.stability_limit.reset();
  const Model scene(load_scene("oscillator"));  // w = 10 rad/s
  const Options options{.step_size = 0.25};
  State state = scene.initial();
  const Summary summary = make_integrator(method, scene.system(), options)->advance(state, 100);
  BOOST_REQUIRE(!(summary.outcome == Outcome::reached_end));
  const std::string why = diagnosis(method, options, scene, 100, summary, 1);
  BOOST_TEST(why.find("above verlet's limit of 2/w_max = 0.2 s") != why.npos, why);
}

BOOST_AUTO_TEST_CASE(growth_that_fades_as_a_power_of_h_is_no_threshold_and_faults_move_limits) {
  const Method heun = verlet_by<Heun>();
  BOOST_TEST(measured_limit(heun) == 0);
  BOOST_TEST(std::abs(qddot::measure::linear_step(heun, 0.5).spectral_radius() -
                      std::sqrt(1 + std::pow(0.5, 4) / 4)) < 1e-14);
  // A second kick longer by d makes the trace 2 - (1 + d/2) (h w)^2, which is to be at least -2.
  const double limit = measured_limit(verlet_by<FaultyVerlet>());
  BOOST_TEST(std::abs(limit - 2 / std::sqrt(1 + 5e-4)) < 1e-10);
}

BOOST_AUTO_TEST_SUITE_END()
