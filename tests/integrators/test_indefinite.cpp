#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(indefinite)

using namespace qddot;

namespace {

constexpr int masses = 5;
constexpr double stiffness = 100;

// A straight column of unit masses and springs along x, each 1/ratio times as long as its room of 1
// m. It swings along itself in its slowest mode, which stays linear. For ratios below 1 it would
// buckle, at rates of up to 2 sqrt(k (1/ratio - 1)) = 27/s. But nothing pushes it off its line, not
// even rounding. M - gamma^2 K is indefinite if gamma is above 1/27 s.
struct Column {
  explicit Column(double ratio)
      : system(make_mass_spring(row_between_pins(masses, 1,
                                                 {.stiffness = stiffness, .rest_length = 1 / ratio},
                                                 [](int) { return 0; })
                                    .network)) {}
  State at(double t) const {
    const double w = 2 * std::sqrt(stiffness) * std::sin(M_PI / (2 * (masses + 1)));
    State s{t, Vec(2 * masses), Vec(2 * masses)};
    for (int i = 0; i < masses; ++i) {
      const double shape = 0.2 * std::sin((i + 1) * M_PI / (masses + 1));
      s.q.segment<2>(2 * i) = (i + 1 + shape * std::cos(w * t)) * u;
      s.v.segment<2>(2 * i) = -w * shape * std::sin(w * t) * u;
    }
    return s;
  }
  Vec u = Vec{{1, 0}};
  std::unique_ptr<System> system;
};
constexpr double t_end = 1;  // s, of a period of 1.2 s
constexpr double compressed = 0.35, in_tension = 1.1;

// Errors reach a few tolerances in one period, or fifty with BDF (see the suite `order`).
double largest_factor(const Method& method) { return method.varies_order() ? 200 : 20; }

}  // namespace

BOOST_DATA_TEST_CASE(steps_on_a_compressed_column_are_right_with_indefinite_matrices,
                     methods_of(Family::sundials, Knob::rtol), method) {
  const Column column(compressed);
  if (!find_method(method.name + "_klu")) return;
  std::int64_t indefinite = 0;
  for (const double rtol : {1e-2, 1e-3, 1e-4, 1e-5}) {
    BOOST_TEST_CONTEXT(method.name << " at " << rtol) {
      Run r = run(method, *column.system, column.at(0), t_end, {.rtol = rtol});
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(distance(r.state, column.at(t_end)) < largest_factor(method) * rtol);
      indefinite += r.summary.counts.indefinite_factorizations;
      // LU, which asks for no sign, takes the same steps.
      const Run klu = run(method_named(method.name + "_klu"), *column.system, column.at(0), t_end,
                          {.rtol = rtol});
      r.summary.counts.indefinite_factorizations = 0;
      BOOST_TEST(klu.summary.counts == r.summary.counts);
      // See the suite `solvers`; of BDF 8e-14 is seen, of ARKODE at 1e-2 8e-9.
      BOOST_TEST(distance(klu.state, r.state) < (method.varies_order() ? 1e-10 : 1e-7));
    }
  }
  BOOST_TEST(indefinite > 0, method.name);
}

BOOST_AUTO_TEST_CASE(long_constant_steps_solve_their_equation_where_it_is_no_minimum) {
  const Column column(compressed);
  for (const double h : {0.1, 0.3, 1.0}) {
    const State start = column.at(0);
    const Run r =
        run(method_named("arkode_implicit_euler"), *column.system, start, h, {.step_size = h});
    BOOST_TEST(r.summary.message == "");
    BOOST_TEST(r.summary.counts.indefinite_factorizations > 0);
    const Vec a = force_at(*column.system, r.state.q);
    // A tenth of Newton's 1e-10 of 5 m, times the 400/s^2 of the stiffest mode, times h.
    BOOST_TEST(distance(r.state.v, start.v + h * a) < 1e-7);
    BOOST_TEST(distance(r.state.q, start.q + h * r.state.v) < 1e-9);
  }
}

BOOST_DATA_TEST_CASE(matrices_are_positive_where_springs_are_in_tension,
                     methods_of(Family::sundials), method) {
  const Column column(in_tension);
  const Run r = run(method, *column.system, column.at(0), t_end, options_of(method, 0.1, 1e-2));
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(r.summary.counts.indefinite_factorizations == 0);
}

BOOST_AUTO_TEST_CASE(semi_implicit_euler_survives_half_of_the_singular_step_and_is_refused_at_it) {
  // One mass of 0.1 kg between two pins, on straight springs compressed to 0.8 of their length.
  // lambda = (2 k/m) (l0/l - 1) = 5000/s^2 across, so that h^2 lambda = 1 at h = 1/sqrt(5000) s.
  Network network{.dimension = 2, .node_mass = Vec::Constant(1, 0.1)};
  const SpringLaw law{.stiffness = 1000, .rest_length = 0.625};
  network.anchors = {{0, {0, 0, 0}, law}, {0, {1, 0, 0}, law}};
  const auto system = make_mass_spring(network);
  const State start{0, Vec{{0.5, 0}}, Vec{{0, 1e-3}}};
  const auto step = [&](double h_squared_lambda) {
    const double h = std::sqrt(h_squared_lambda / 5000);
    return run(method_named("semi_implicit_euler"), *system, start, h, {.step_size = h});
  };
  // v' = v / (1 - h^2 lambda) across: twice as fast, the exact motion e^(1/sqrt 2) = 2.03 times.
  const Run half = step(0.5);
  BOOST_TEST(half.summary.message == "");
  BOOST_TEST(half.state.v[1] == 2e-3, boost::test_tools::tolerance(1e-12));
  const Run singular = step(1);
  BOOST_TEST(name(singular.summary.outcome) == "indefinite_matrix");
  BOOST_TEST(same(singular.state, start));
  // Beyond it solves, and turns the motion round: -v / 3.
  const Run beyond = step(4);
  BOOST_TEST(beyond.summary.message == "");
  BOOST_TEST(beyond.state.v[1] == -1e-3 / 3, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_SUITE_END()
