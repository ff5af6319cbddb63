#include <latch>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "qddot/scene/scene_file.hpp"

BOOST_AUTO_TEST_SUITE(deadline)

using namespace qddot;

namespace {

constexpr double never = 1e300;

// Waits as long as it takes.
void wait_for(const Deadline& deadline) {
  std::latch passed(1);
  const std::stop_callback wake(deadline.token(), [&] { passed.count_down(); });
  passed.wait();
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_asks_for_a_stop_when_its_time_has_come) {
  const Deadline deadline(0.01);
  wait_for(deadline);
  BOOST_TEST(deadline.passed());
  BOOST_TEST(deadline.token().stop_requested());
}

BOOST_AUTO_TEST_CASE(no_time_at_all_passes_at_once) {
  const Deadline deadline(0);
  wait_for(deadline);
  BOOST_TEST(deadline.passed());
}

BOOST_AUTO_TEST_CASE(a_run_that_would_take_for_ever_ends_by_it) {
  const ReducedScene scene(load_scene("oscillator"));
  const auto integrator =
      make_integrator(*find_method("verlet"), scene.system(), {.step_size = 1e-14});
  const Deadline deadline(0.01);
  State state = scene.initial();
  const Summary summary = integrator->advance(state, 1, {}, deadline.token());
  BOOST_TEST((summary.outcome == Outcome::over_budget));
  BOOST_TEST(summary.t_reached < 1);
  BOOST_TEST(!summary.message.empty());
}

BOOST_AUTO_TEST_CASE(destroyed_early_it_neither_waits_nor_asks) {
  std::stop_token token;
  for (int i = 0; i < 100; ++i) {
    const Deadline deadline(never);
    token = deadline.token();
    BOOST_TEST(!deadline.passed());
  }
  BOOST_TEST(!token.stop_requested());
}

BOOST_AUTO_TEST_SUITE_END()
