// Random scenes with dashpots and air against an independent model, with each set of reductions and
// by each method.
#include <boost/test/unit_test.hpp>

#include "tests/independent/comparison.hpp"
#include "tests/independent/random_scene.hpp"

BOOST_AUTO_TEST_SUITE(damped_motion)

using namespace qddot;

BOOST_AUTO_TEST_CASE(random_damped_scenes_move_as_they_are_drawn) {
  int damped = 0;
  // Each kind of scene three times.
  for (std::uint64_t seed = 500; seed < 533; ++seed) {
    const auto [scene, kind] = damped_scene(seed);
    damped += is_damped(scene);
    BOOST_TEST_CONTEXT("seed " << seed << ", " << kind) {
      for (const std::string& sentence : compare_states(scene, seed).disagreements)
        BOOST_ERROR(sentence);
      const DrawnMotion motion(scene);
      for (const std::string& sentence : compare_reductions(motion).disagreements)
        BOOST_ERROR(sentence);
      if (seed % 3 > 0) continue;
      for (const std::string& sentence : compare_methods(motion).disagreements)
        BOOST_ERROR(sentence);
    }
  }
  BOOST_TEST(damped >= 30);
}

BOOST_AUTO_TEST_SUITE_END()
