#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(solvers)

using namespace qddot;

namespace {

// Solves that round differently, by some 1e-15, change error estimates of 1e-3 or less by 1e-12 in
// a hundred stages. Estimates change the lengths of steps: the end changes by up to 6e-12. ARKODE's
// rates are also differences of solutions over a part of a step. They change the end by 1.1e-9 in
// its methods of high order at coarse tolerances.
constexpr double by_rounding = 1e-10, by_coarse_rates = 1e-8;

}  // namespace

// Fixed steps are the same ones, solved to 1e-10 and less of what changes in each; steps that are
// chosen may fall elsewhere, and agree to some tolerances.
BOOST_DATA_TEST_CASE(every_method_ends_in_the_same_state_with_every_solver,
                     methods_with(Option::solver), method) {
  const Problem p = problem_for(method, 3);
  BOOST_TEST(methods_with(Option::solver).size() >= 20u);
  Options options = options_of(method, 0.01, 1e-6);
  options.solve_tolerance = 1e-10;
  options.solver = Solver::multifrontal;
  const Run reference = run(method, p, 1, options);
  BOOST_TEST(reference.summary.message == "", method.name);
  for (const auto& [solver, name] : solver_names) {
    BOOST_TEST_CONTEXT(method.name << " with " << name) {
      options.solver = solver;
      const Run r = run(method, p, 1, options);
      BOOST_TEST(r.summary.message == "");
      const bool is_fixed = method.knob == Knob::step_size;
      BOOST_TEST(distance(r.state, reference.state) < (is_fixed ? 1e-7 : 1e-3));
      if (is_fixed) BOOST_TEST(r.summary.counts.steps == reference.summary.counts.steps);
    }
  }
}

// A column of unit masses in 2D, compressed to a third and slightly bent to both sides. M - h^2 K
// is indefinite in these steps, which conjugate gradients see in a solve. Minimisations keep less
// of the compression; a formula with the full K reports why it cannot go on.
BOOST_AUTO_TEST_CASE(compression_is_softened_or_reported_with_conjugate_gradients) {
  const Problem p = row_between_pins(5, 1, {.stiffness = 1e4, .rest_length = 3}, [](int i) {
    return (i % 2 == 0 ? 0.01 : -0.02) * (1 + 0.3 * i);
  });
  const auto system = make_mass_spring(p.network);
  const Options options{.step_size = 0.05, .solver = Solver::conjugate_gradients};
  const Run minimised = run(method_named("implicit_euler"), *system, p.initial, 1, options);
  BOOST_TEST(minimised.summary.message == "");
  BOOST_TEST(total_energy(*system, minimised.state) < 0.5 * total_energy(*system, p.initial));
  const Run formula = run(method_named("semi_implicit_euler"), *system, p.initial, 1, options);
  BOOST_TEST((formula.summary.outcome == Outcome::indefinite_matrix));
  BOOST_TEST(formula.summary.message.find("--solver multifrontal") != std::string::npos);
  const Run direct = run(method_named("semi_implicit_euler"), *system, p.initial, 0.05,
                         {.step_size = 0.05, .solver = Solver::multifrontal});
  BOOST_TEST(direct.summary.message == "");
}

// Light masses on stiff springs beside heavy ones on soft springs: what a solve leaves is seen in
// the light ones first.
BOOST_AUTO_TEST_CASE(rodas4_is_as_accurate_with_conjugate_gradients_as_with_factors) {
  std::mt19937 random(13);
  for (int scene = 0; scene < 8; ++scene) {
    Problem p = random_network(random, 2, 10, 1.2);
    const auto power = [&](double low, double high) {
      return std::pow(10, std::uniform_real_distribution<>(low, high)(random));
    };
    for (double& mass : p.network.node_mass) mass *= power(-3, 0);
    for (auto& link : p.network.links) link.law.stiffness *= power(0, 3);
    const Run exact = run(method_named("dprkn12"), p, 0.01, {.rtol = 1e-13});
    for (const double rtol : {1e-4, 1e-6, 1e-8}) {
      const auto error = [&](Solver solver) {
        const Run r = run(method_named("rodas4"), p, 0.01, {.rtol = rtol, .solver = solver});
        BOOST_TEST(r.summary.message == "");
        return distance(r.state, exact.state);
      };
      const double direct = error(Solver::multifrontal);
      const double iterative = error(Solver::conjugate_gradients);
      // Half as much again: the solves' share of all that the steps err by.
      BOOST_TEST(iterative < 1.5 * direct, scene << " at " << rtol << ": " << iterative / direct);
    }
  }
}

// Fixed nodes so far apart in stiffness that ten thousand iterations do not do.
BOOST_AUTO_TEST_CASE(too_many_iterations_are_told) {
  constexpr int masses = 30000;
  const Network network = linear_chain(masses, 1e-9, 1);
  const auto system = make_mass_spring(network);
  State start{0, Vec::LinSpaced(masses, 1, masses), Vec::Zero(masses)};
  start.v[0] = 1;
  const Run r = run(method_named("semi_implicit_euler"), *system, start, 10,
                    {.step_size = 10, .solver = Solver::conjugate_gradients});
  BOOST_TEST((r.summary.outcome == Outcome::solver_failed));
  BOOST_TEST(r.summary.message.find("did not converge") != std::string::npos);
}

// The methods that solve with stock KLU; each is the stock way of one with n x n solves.
BOOST_DATA_TEST_CASE(n_x_n_solves_and_klu_take_the_same_steps, stock_methods(), twin) {
  for (const int dimension : {2, 3}) {
    const Problem p = hammock(dimension);
    for (const double rtol : {1e-3, 1e-6}) {
      BOOST_TEST_CONTEXT(twin.name << " in dimension " << dimension << ", rtol " << rtol) {
        const Run n_x_n = run(method_named(twin.stock_of), p, 1, {.rtol = rtol});
        Run klu = run(twin, p, 1, {.rtol = rtol});
        BOOST_TEST(n_x_n.summary.message == "");
        BOOST_TEST(n_x_n.summary.counts.steps > 5);
        klu.summary.counts.indefinite_factorizations =
            n_x_n.summary.counts.indefinite_factorizations;  // which LU does not see
        BOOST_TEST(n_x_n.summary.counts == klu.summary.counts);
        const bool has_coarse_rates = !twin.varies_order() && rtol > 1e-6;
        BOOST_TEST(distance(n_x_n.state, klu.state) <
                   (has_coarse_rates ? by_coarse_rates : by_rounding));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
