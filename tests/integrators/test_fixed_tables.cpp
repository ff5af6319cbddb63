#include <complex>
#include <functional>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(fixed_tables)

using namespace qddot;

namespace {

using Complex = std::complex<double>;

const double gamma_sdirk = 1 - 1 / std::sqrt(2.0), gamma_tr = 2 - std::sqrt(2.0);

// The factor by which a step multiplies the solution of y' = lambda y, z = h lambda, and its limit
// for long steps.
struct Formula {
  const char* method;
  std::function<Complex(Complex)> amplification;
};
const Formula formulas[] = {
    {"arkode_implicit_euler", [](Complex z) { return 1.0 / (1.0 - z); }},
    {"arkode_implicit_midpoint", [](Complex z) { return (1.0 + z / 2.0) / (1.0 - z / 2.0); }},
    {"arkode_sdirk2",
     [](Complex z) {
       const double g = gamma_sdirk;
       return (1.0 + (1 - 2 * g) * z) / ((1.0 - g * z) * (1.0 - g * z));
     }},
    // The trapezoidal rule to gamma h, then BDF2 on the three times 0, gamma h, h.
    {"arkode_trbdf2", [](Complex z) {
       const double g = gamma_tr;
       const Complex middle = (1.0 + g * z / 2.0) / (1.0 - g * z / 2.0);
       return (middle - (1 - g) * (1 - g)) / (g * (2 - g)) / (1.0 - (1 - g) / (2 - g) * z);
     }}};

// u = w x + i v of the oscillator, u' = -i w u.
Complex amplitude(const Oscillator& o, const State& s) { return {o.omega() * s.q[0], s.v[0]}; }

// |u_n - R(-i h w)^n u_0| / |u_0| after n steps.
double defect(const Formula& formula, double hw, int steps) {
  const Oscillator o;
  const Problem p = o.problem();
  const auto system = make_mass_spring(p.network);
  const double h = hw / o.omega();
  const Run r = run(method_named(formula.method), *system, p.initial, steps * h, {.step_size = h});
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(r.summary.counts.steps == steps);
  const Complex start = amplitude(o, p.initial);
  const Complex expected = std::pow(formula.amplification({0, -hw}), steps) * start;
  return std::abs(amplitude(o, r.state) - expected) / std::abs(start);
}

// A diagonally implicit table, row by row; the step is y + h sum of b_i F(stage i).
struct Table {
  const char* method;
  Eigen::MatrixXd a;
  Vec b;
};
std::vector<Table> tables() {
  const double g = gamma_sdirk, w = std::sqrt(2.0) / 4, d = gamma_tr / 2;
  return {{"arkode_implicit_euler", Eigen::MatrixXd{{1.0}}, Vec{{1.0}}},
          {"arkode_implicit_midpoint", Eigen::MatrixXd{{0.5}}, Vec{{1.0}}},
          {"arkode_sdirk2", Eigen::MatrixXd{{g, 0}, {1 - g, g}}, Vec{{1 - g, g}}},
          {"arkode_trbdf2", Eigen::MatrixXd{{0, 0, 0}, {d, d, 0}, {w, w, d}}, Vec{{w, w, d}}}};
}

// A step of the table, by an iteration of the stages' equations that shrinks by (h w)^2 a_ii^2 <
// 0.3 a round.
State step(const Table& table, const System& system, const State& start, double h) {
  const Index n = system.size(), stages = table.b.size();
  Eigen::MatrixXd q_rate = Eigen::MatrixXd::Zero(n, stages), v_rate = q_rate;
  for (int round = 0; round < 100; ++round) {
    for (Index i = 0; i < stages; ++i) {
      const Vec row = h * table.a.row(i).transpose();
      const Vec q = start.q + q_rate * row, v = start.v + v_rate * row;
      q_rate.col(i) = v;
      v_rate.col(i) = force_at(system, q).cwiseQuotient(system.mass());
    }
  }
  return {start.t + h, start.q + h * q_rate * table.b, start.v + h * v_rate * table.b};
}

// Newton's iteration leaves a relative error of a tenth of 1e-10 in each stage. It leaves far less
// if the motion is linear, as a second iteration confirms the first.
constexpr double newton = 1e-10;
// The effect of Newton's tolerance after 100 steps.
constexpr double newton_of_100_steps = 1e-8;

}  // namespace

BOOST_AUTO_TEST_CASE(one_step_multiplies_the_oscillators_amplitude_by_the_tables_own_factor) {
  for (const Formula& formula : formulas) {
    for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
      BOOST_TEST_CONTEXT(formula.method << " at h w = " << hw) {
        BOOST_TEST(defect(formula, hw, 1) < newton);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(many_steps_multiply_it_by_the_power_of_that_factor) {
  for (const Formula& formula : formulas) {
    for (const double hw : {0.01, 0.3, 1.0, 5.0}) {
      BOOST_TEST_CONTEXT(formula.method << " at h w = " << hw) {
        BOOST_TEST(defect(formula, hw, 100) < newton_of_100_steps);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(another_factor_and_another_step_are_noticed) {
  for (const Formula& formula : formulas) {
    for (const Formula& other : formulas) {
      const Formula wrong{formula.method, other.amplification};
      // SDIRK's and TR-BDF2's factors are the same: both have the pole 1/g, twice, and order 2.
      const Complex z(0, -0.3);
      const bool is_same = std::abs(formula.amplification(z) - other.amplification(z)) < 1e-15;
      BOOST_TEST((defect(wrong, 0.3, 1) < newton) == is_same);
    }
    const Formula longer{formula.method,
                         [&](Complex z) { return formula.amplification(1.00001 * z); }};
    BOOST_TEST(defect(longer, 0.3, 1) > 100 * newton);
  }
}

BOOST_AUTO_TEST_CASE(implicit_euler_by_arkode_is_the_hand_written_one) {
  for (const Problem& p : {linear_hammock(1), linear_hammock(3), hammock(2), hammock(3)}) {
    const auto system = make_mass_spring(p.network);
    for (const double h : {0.003, 0.01, 0.05}) {
      BOOST_TEST_CONTEXT("h = " << h) {
        // The run has a shorter last step.
        const Options options{.step_size = h, .solve_tolerance = 1e-13};
        const double t_end = 100.4 * h;
        const Run ours = run(method_named("implicit_euler"), *system, p.initial, t_end, options);
        const Run theirs =
            run(method_named("arkode_implicit_euler"), *system, p.initial, t_end, options);
        BOOST_TEST(ours.summary.message == "");
        BOOST_TEST(theirs.summary.message == "");
        BOOST_TEST(theirs.summary.counts.steps == 101);
        BOOST_TEST(distance(ours.state, theirs.state) < newton_of_100_steps);
        const Run other =
            run(method_named("semi_implicit_euler"), *system, p.initial, t_end, options);
        if (!system->stiffness_is_constant()) {
          BOOST_TEST(distance(ours.state, other.state) > 1e-4);  // noticed
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(one_step_on_a_nonlinear_scene_solves_the_equations_of_the_table) {
  for (const int dimension : {2, 3}) {
    const Problem p = hammock(dimension);
    const auto system = make_mass_spring(p.network);
    const double h = 0.02;
    std::vector<State> ends;
    for (const Table& table : tables()) {
      BOOST_TEST_CONTEXT(table.method << " in dimension " << dimension) {
        const Run r = run(method_named(table.method), *system, p.initial, h, {.step_size = h});
        BOOST_TEST(r.summary.message == "");
        const State expected = step(table, *system, p.initial, h);
        // Forces of 100 N/m on masses of about 1 kg, times h.
        BOOST_TEST(distance(r.state, expected) < 2 * newton);
        for (const State& other : ends) BOOST_TEST(distance(other, expected) > 1e-6);  // noticed
        ends.push_back(expected);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
