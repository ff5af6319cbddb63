#include <boost/test/unit_test.hpp>

#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/model/capabilities.hpp"
#include "tests/measure/drawn_scenes.hpp"

BOOST_AUTO_TEST_SUITE(step_cost)

using namespace qddot;

// A cloth in a frame of named stiff springs; the steps solve for the frame alone.
BOOST_AUTO_TEST_CASE(linearly_implicit_steps_cost_what_they_solve_for) {
  Scene scene = drawn("framed_cloth", {{"nodes", 30}});
  const ReducedScene framed(scene);
  scene.stiff_above.reset();
  const ReducedScene whole(scene);
  const Split* split = split_of(framed.system());
  BOOST_TEST_REQUIRE((split && !split_of(whole.system())));
  BOOST_TEST_REQUIRE(framed.system().size() == whole.system().size());
  BOOST_TEST_REQUIRE(10 * split->stiff_unknowns.size() <
                     2 * static_cast<std::size_t>(framed.system().size()));
  for (const char* name : {"linear_midpoint", "linear_midpoint4"})
    // A fifth of the unknowns at most, and factors that grow faster than these.
    BOOST_TEST(usual_step_cost(method(name), framed.system()) <
               0.2 * usual_step_cost(method(name), whole.system()) + 1);
  for (const char* name : {"trapezoidal", "verlet"})
    BOOST_TEST(usual_step_cost(method(name), framed.system()) ==
               usual_step_cost(method(name), whole.system()));
  BOOST_TEST(std::isinf(usual_step_cost(method("dprkn12"), framed.system())));
}

BOOST_AUTO_TEST_SUITE_END()
