#include <map>

#include <boost/test/unit_test.hpp>

#include "integrators/sundials/version.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(sundials)

using namespace qddot;

// A frame in which h w_max is some hundreds for the steps that the cloth needs. Whatever the
// iteration leaves in it is multiplied by the square of that where it is taken for a motion.
BOOST_AUTO_TEST_CASE(a_coarser_tolerance_costs_no_more_steps_however_stiff_the_scene) {
  const Model scene = framed_cloth(10);
  for (const char* method : {"arkode_dirk2", "arkode_dirk3", "arkode_dirk4", "arkode_dirk5"}) {
    const auto steps = [&](double rtol) {
      const Run r = run(method_named(method), scene.system(), scene.initial(), 0.1,
                        {.rtol = rtol, .speed = 3});
      BOOST_TEST(r.summary.message == "");
      return r.summary.counts.steps;
    };
    const auto fine = steps(1e-5);
    for (const double rtol : {1e-1, 1e-2, 1e-3, 1e-4}) {
      // From 7.1 on a first stage takes the rate that the last one was solved to, and the coarsest
      // tolerance may cost some more steps again.
      BOOST_TEST(steps(rtol) <= (QDDOT_SUNDIALS < 70100 ? fine : fine + fine / 4),
                 method << " at " << rtol);
    }
  }
}

BOOST_AUTO_TEST_CASE(our_counts_and_those_of_sundials_fit_together) {
  const Problem p = hammock(2);
  // ARKODE evaluates one force for each Newton iteration. It evaluates one more at an explicit
  // stage, which begins the tables of order 3 and 5; from 7.1 on that is the last stage of the step
  // before. So it does at the end of a step that is no
  // stage (order 2). It evaluates none at the solutions of implicit stages, and IDA none besides
  // iterations. We count forces and stiffnesses, SUNDIALS steps, iterations and factorisations.
  constexpr int first_stage = QDDOT_SUNDIALS >= 70100 ? 0 : 1;
  const std::map<std::string, std::int64_t> forces_a_step = {{"arkode_dirk2", 1},
                                                             {"arkode_dirk3", first_stage},
                                                             {"arkode_dirk4", 0},
                                                             {"arkode_dirk5", first_stage},
                                                             {"ida", 0}};
  for (const auto& [method, forces] : forces_a_step) {
    BOOST_TEST_CONTEXT(method) {
      const Counts c = run(method_named(method), p, 1, {.rtol = 1e-7}).summary.counts;
      const auto attempts = c.steps + c.rejected;
      const auto rest = c.force_evaluations - c.newton_iterations - forces * attempts;
      // The first force, and the few of the first step size; less where an attempt ended early.
      BOOST_TEST(rest >= 1 - 8 * c.rejected);
      BOOST_TEST(rest <= 6);
      BOOST_TEST(c.steps >= 40);
      BOOST_TEST(c.solves == c.newton_iterations);
      BOOST_TEST(c.newton_iterations >= c.steps);
      BOOST_TEST(c.factorizations >= c.stiffness_evaluations);
      BOOST_TEST(c.stiffness_evaluations > 0);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
