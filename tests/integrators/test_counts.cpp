#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/kick_drift.hpp"
#include "tests/integrators/tables.hpp"

BOOST_AUTO_TEST_SUITE(counts)

using namespace qddot;

namespace {

constexpr std::int64_t steps = 37;
constexpr double h = 0.01;

Counts count(const std::string& method, const Problem& p, double t_end = steps * h) {
  const Run r = run(method_named(method), p, t_end, {.step_size = h});
  BOOST_REQUIRE(r.summary.message == "");
  return r.summary.counts;
}

// The work of a step, and of a run that begins, where K is constant.
struct Cost {
  std::string method;
  std::int64_t forces, to_begin;
  std::int64_t solves = 0, matrices = 0;  // each matrix is factorised

  Counts of_run() const {
    return {.steps = steps,
            .force_evaluations = forces * steps + to_begin,
            .stiffness_evaluations = matrices,
            .factorizations = matrices,
            .solves = solves * steps};
  }
};
std::vector<Cost> explicit_methods() {
  std::vector<Cost> list = {{"explicit_euler", 1, 0}, {"symplectic_euler", 1, 0}, {"rk4", 4, 0}};
  // The last force of a step is the first of the next if a kick is first.
  for (const auto& [name, table] : methods_with_tables(&Method::splitting)) {
    const bool kicks_first = table.kicks.size() > table.drifts.size();
    list.push_back({name, std::ssize(kicks_first ? table.drifts : table.kicks), kicks_first});
  }
  return list;
}
// One factorisation for each change of the step size: of linear_midpoint4's to p, and there and
// back. Where K changes there is one for each solve.
const Cost linearly_implicit[] = {{"semi_implicit_euler", 1, 0, 1, 1},
                                  {"linear_midpoint", 1, 0, 1, 1},
                                  {"linear_midpoint4", 5, 0, 5, 1 + 2 * steps}};
const Cost iterating[] = {{"implicit_euler", 1, 0, 1, 1},
                          {"implicit_midpoint", 1, 1, 1, 1},
                          {"trapezoidal", 1, 1, 1, 1},
                          {"generalized_alpha", 1, 1, 1, 1},
                          {"hht", 1, 1, 1, 1},
                          {"trbdf2", 2, 1, 2, 1},
                          {"discrete_gradient", 1, 1, 1, 1},
                          {"bdf2", 1, 0, 1, 2}};  // its first step's c is 1

}  // namespace

BOOST_AUTO_TEST_CASE(explicit_methods_take_their_forces_a_step_and_those_to_begin) {
  for (const Cost& cost : explicit_methods()) {
    for (const Problem& p : {hammock(2), linear_hammock(2)})
      BOOST_TEST(count(cost.method, p) == cost.of_run(), cost.method);
  }
}

BOOST_AUTO_TEST_CASE(where_k_is_constant_a_run_takes_one_factorisation_for_each_step_size) {
  for (const Cost& cost : linearly_implicit) {
    BOOST_TEST(count(cost.method, linear_hammock(2)) == cost.of_run(), cost.method);
  }
  for (const Cost& cost : iterating) {
    Counts expected = cost.of_run();
    expected.newton_iterations = expected.solves;
    BOOST_TEST(count(cost.method, linear_hammock(2)) == expected, cost.method);
  }
  for (const char* method : {"semi_implicit_euler", "implicit_euler"}) {
    const Counts c = count(method, linear_hammock(2), (steps + 0.4) * h);  // a shorter last step
    BOOST_TEST(c.steps == steps + 1);
    BOOST_TEST(c.factorizations == 2);
    BOOST_TEST(c.stiffness_evaluations == 2);
  }
}

BOOST_AUTO_TEST_CASE(linearly_implicit_methods_factorise_for_each_solve_where_k_changes) {
  for (Cost cost : linearly_implicit) {
    cost.matrices = cost.solves * steps;
    BOOST_TEST(count(cost.method, hammock(2)) == cost.of_run(), cost.method);
  }
}

BOOST_AUTO_TEST_CASE(where_k_changes_a_force_and_a_solve_an_iteration_and_few_factorisations) {
  for (const Cost& cost : iterating) {
    BOOST_TEST_CONTEXT(cost.method) {
      const Counts c = count(cost.method, hammock(2), 1);
      BOOST_TEST(c.steps == 100);
      BOOST_TEST(c.solves == c.newton_iterations);
      BOOST_TEST(c.newton_iterations > c.steps);
      BOOST_TEST(c.newton_iterations <= 5 * cost.solves * c.steps);
      BOOST_TEST(c.stiffness_evaluations == c.factorizations);
      // A solve whose correction shrinks too slowly is made again with new factors, at the same u.
      const std::int64_t forces = c.force_evaluations - cost.to_begin;
      BOOST_TEST(forces <= c.newton_iterations);
      BOOST_TEST(forces >= c.newton_iterations - c.factorizations);
      BOOST_TEST(c.factorizations < c.steps / 4);  // not one a step
    }
  }
  // In a motion as smooth as this, the first factors are enough for 37 steps of implicit Euler, and
  // every full correction is accepted.
  const Counts c = count("implicit_euler", hammock(2));
  Counts expected = Cost{"implicit_euler", 0, c.newton_iterations, 0, 1}.of_run();
  expected.solves = expected.newton_iterations = c.newton_iterations;
  BOOST_TEST(c == expected);
}

BOOST_AUTO_TEST_CASE(counts_are_added_one_by_one) {
  Counts sum{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  sum += {100, 200, 300, 400, 500, 600, 700, 800, 900, 1000, 1100};
  BOOST_TEST(sum == (Counts{101, 202, 303, 404, 505, 606, 707, 808, 909, 1010, 1111}));
}

BOOST_DATA_TEST_CASE(every_method_counts_each_call_that_reaches_the_system, general_methods(),
                     method) {
  const Problem p = hammock(3);
  const auto system = make_mass_spring(p.network);
  Relay relay(*system);
  const auto integrator = make_integrator(method, relay, options_of(method, 0.01, 1e-5));
  const Asked asked(relay);
  State state = p.initial;
  const Summary summary = integrator->advance(state, 0.3);
  BOOST_TEST(summary.message == "");
  BOOST_TEST(summary.counts.force_evaluations == asked.force);
  BOOST_TEST(summary.counts.stiffness_evaluations == asked.stiffness);
}

BOOST_AUTO_TEST_SUITE_END()
