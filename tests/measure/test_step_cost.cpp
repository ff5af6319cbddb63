#include <boost/test/unit_test.hpp>

#include "qddot/measure/advice/forecast.hpp"
#include "qddot/measure/advice/frequency_error.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "tests/measure/drawn_scenes.hpp"

using namespace qddot;

BOOST_AUTO_TEST_SUITE(step_cost)

// The stages of the published schemes; the last one of a step that is the first of the next counts
// once.
BOOST_AUTO_TEST_CASE(a_step_takes_the_forces_of_its_formula) {
  for (const auto& [name, forces] :
       {std::pair("verlet", 1.), std::pair("position_verlet", 1.), std::pair("rk4", 4.),
        std::pair("symmetric8", 1.), std::pair("blanes_moan4", 6.), std::pair("kahan_li8", 17.)})
    BOOST_TEST(forces_a_step(method(name)) == forces, name);
}

// Its name is in no list.
BOOST_AUTO_TEST_CASE(a_new_method_is_counted_and_forecast_by_its_steps) {
  static Method unknown = method("blanes_moan4");
  unknown.name = "unknown";
  BOOST_TEST(forces_a_step(unknown) == 6);
  BOOST_TEST(is_forecast_by_frequency(unknown));
  for (const double error : {1e-3, 1e-6})
    BOOST_TEST(largest_h_omega(unknown, error) == largest_h_omega(method("blanes_moan4"), error));
}

BOOST_AUTO_TEST_SUITE_END()
