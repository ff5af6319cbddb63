#include <map>

#include <boost/test/unit_test.hpp>

#include "qddot/analysis/linear_motion.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(sundials)

using namespace qddot;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The tolerance is for the estimated error of each step in the root mean square over q and v. These
// motions last two to three periods. The largest error of any entry is 0.1 to 25 tolerances with
// ARKODE (60 with order 3 at 1e-7, which takes the most steps). It is up to 1100 with multistep
// methods, whose order rises and falls. A Newton iteration that stops too early gives 1e4 and more.
double largest_factor(const Method& method) {
  return method.name.starts_with("arkode") ? 100 : 2000;
}

// Errors at rtol = 1e-3, 1e-5, 1e-7 as multiples of rtol, and whether they fall.
struct Accuracy {
  double worst_factor = 0;
  bool falls = true;
};

Accuracy accuracy(const Method& method, const System& system, const State& start,
                  const State& end) {
  Accuracy result;
  double last = INFINITY;
  for (const double rtol : {1e-3, 1e-5, 1e-7}) {
    const Run r = run(method, system, start, end.t, {.rtol = rtol});
    BOOST_REQUIRE(r.summary.message == "");
    const double error = distance(r.state, end);
    result.worst_factor = std::max(result.worst_factor, error / rtol);
    result.falls = result.falls && error < last;
    last = error;
  }
  return result;
}

void check_accuracy(const System& system, const State& start, const State& end) {
  for (const Method& method : methods_of(Family::sundials, Knob::rtol)) {
    BOOST_TEST_CONTEXT(method.name) {
      const Accuracy a = accuracy(method, system, start, end);
      BOOST_TEST(a.falls);
      BOOST_TEST(a.worst_factor < largest_factor(method));
    }
  }
}

void check_accuracy_where_linear(const Problem& p, double until) {
  const auto system = make_mass_spring(p.network);
  check_accuracy(*system, p.initial, LinearMotion(*system).after(p.initial, until));
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_oscillator_is_as_exact_as_the_tolerance_asks) {
  check_accuracy_where_linear(Oscillator{}.problem(), 2.4);
}

BOOST_AUTO_TEST_CASE(linear_networks_are_as_exact_as_the_tolerance_asks) {
  for (const int dimension : {1, 2, 3}) check_accuracy_where_linear(linear_hammock(dimension), 1);
}

BOOST_AUTO_TEST_CASE(nonlinear_networks_are_as_exact_as_the_tolerance_asks) {
  for (const int dimension : {2, 3}) {
    const Problem p = hammock(dimension);
    const auto system = make_mass_spring(p.network);
    // Exact to 1e-12, see the suite `order`.
    const Run exact =
        run(method_named("kahan_li8"), *system, p.initial, 1, {.step_size = 1. / 512});
    check_accuracy(*system, p.initial, exact.state);
  }
}

BOOST_AUTO_TEST_CASE(a_force_wrong_by_a_thousandth_is_noticed) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  Relay wrong(*system);
  wrong.after_force = [](const ConstVec&, MutableVec f) { f *= 1.001; };
  const Run exact = run(method_named("kahan_li8"), *system, p.initial, 1, {.step_size = 1. / 512});
  for (const Method& method : methods_of(Family::sundials, Knob::rtol)) {
    BOOST_TEST(accuracy(method, wrong, p.initial, exact.state).worst_factor >
               largest_factor(method));
  }
}

BOOST_AUTO_TEST_CASE(the_steps_of_arkode_show_the_order_of_its_table) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  const auto exact = [&](double until) {
    return run(method_named("kahan_li8"), *system, p.initial, until, {.step_size = 1. / 1024})
        .state;
  };
  const State near = exact(1), far = exact(6);
  for (const Method& method : methods_of(Family::sundials, Knob::rtol)) {
    if (!method.name.starts_with("arkode")) continue;  // the order varies
    // ARKODE keeps a step size until it can be longer by half. The highest orders take some ten
    // steps in a second, too few to show the order.
    const bool is_high = method.order > 5;
    const double rtol = method.order == 2 ? 1e-4 : is_high ? 1e-8 : 1e-7;
    const double order = order_by_tolerance(method, *system, p.initial, is_high ? far : near, rtol);
    // Up to 0.06 is seen.
    BOOST_TEST(std::abs(order - method.order) < 0.2, method.name << " shows " << order);
  }
}

// A frame in which h w_max is some hundreds for the steps that the cloth needs. Whatever the
// iteration leaves in it is multiplied by the square of that where it is taken for a motion.
BOOST_AUTO_TEST_CASE(a_coarser_tolerance_costs_no_more_steps_however_stiff_the_scene) {
  const ReducedScene scene = framed_cloth(10);
  for (const char* method : {"arkode_dirk2", "arkode_dirk3", "arkode_dirk4", "arkode_dirk5"}) {
    const auto steps = [&](double rtol) {
      const Run r = run(method_named(method), scene.system(), scene.initial(), 0.1,
                        {.rtol = rtol, .speed = 3});
      BOOST_TEST(r.summary.message == "");
      return r.summary.counts.steps;
    };
    const auto fine = steps(1e-5);
    for (const double rtol : {1e-1, 1e-2, 1e-3, 1e-4}) {
      BOOST_TEST(steps(rtol) <= fine, method << " at " << rtol);
    }
  }
}

BOOST_AUTO_TEST_CASE(our_counts_and_those_of_sundials_fit_together) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  // ARKODE evaluates one force for each Newton iteration. It evaluates one more at an explicit
  // stage, which begins the tables of order 3 and 5, and at the end of a step that is no stage
  // (order 2). It evaluates none at the solutions of implicit stages, and IDA none besides
  // iterations. We count forces and stiffnesses, SUNDIALS steps, iterations and factorisations.
  const std::map<std::string, std::int64_t> forces_a_step = {{"arkode_dirk2", 1},
                                                             {"arkode_dirk3", 1},
                                                             {"arkode_dirk4", 0},
                                                             {"arkode_dirk5", 1},
                                                             {"ida", 0}};
  for (const auto& [method, forces] : forces_a_step) {
    BOOST_TEST_CONTEXT(method) {
      const Counts c =
          run(method_named(method), *system, p.initial, 1, {.rtol = 1e-7}).summary.counts;
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

BOOST_AUTO_TEST_CASE(the_summary_of_a_method_names_its_library_and_table) {
  const std::map<std::string, std::string> tables = {{"arkode_dirk2", "ARKODE_SDIRK_2_1_2"},
                                                     {"arkode_dirk3", "ARKODE_KVAERNO_4_2_3"},
                                                     {"arkode_dirk4", "ARKODE_SDIRK_5_3_4"},
                                                     {"arkode_dirk5", "ARKODE_ESDIRK547L2SA_7_4_5"},
                                                     {"ida", "BDF of order 1 to 5"}};
  for (const auto& [method, table] : tables) {
    BOOST_TEST_CONTEXT(method) {
      const Method& m = method_named(method);
      BOOST_TEST(contains(m.summary, table));
      BOOST_TEST(contains(m.summary, "SUNDIALS"));
      BOOST_TEST(contains(m.summary, std::to_string(m.order)));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
