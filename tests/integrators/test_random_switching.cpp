#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "tests/switching_comparison.hpp"

// Random scenes with cables and springs that break, against an integrator that shares only the
// scene with qddot. The program fuzz_switching compares more of them by more methods.
BOOST_AUTO_TEST_SUITE(random_switching)

using namespace qddot;

namespace {

// All disagreements, a line each; nothing of a scene whose motion is not known.
std::string disagreements(const Scene& scene) {
  const KnownSwitching known(scene);
  if (!known.why_unknown().empty()) return "";
  SwitchingComparison comparison(known);
  const Model model(scene);
  for (const char* name : {"verlet", "rk4", "dprkn8", "arkode_erk8", "cvode_bdf", "trapezoidal"})
    comparison.compare(*find_method(name), model, "");
  std::string lines;
  for (const std::string& one : comparison.results().disagreements) lines += one + "\n";
  return lines;
}

// A mass that falls onto its cable: x = x0 + g t^2/2, then a vibration about l0 + m g/k.
struct Bouncer {
  double x0 = 0.6, l0 = 1, k = 400, g = 9.81;

  Scene scene() const {
    Scene one{.dimension = 1, .gravity = {g, 0, 0}, .until = 1};
    one.nodes = {{.pinned = true}, {.position = {x0, 0, 0}, .mass = 1}};
    one.springs = {{{0, 1}, {.stiffness = k, .rest_length = l0, .pulls_only = true}}};
    return one;
  }
  double fall() const { return std::sqrt(2 * (l0 - x0) / g); }
  double taut() const { return 2 * std::atan2(g * fall() * std::sqrt(k), -g) / std::sqrt(k); }
};

}  // namespace

// The independent integrator itself.
BOOST_AUTO_TEST_CASE(the_integrator_finds_the_moments_of_a_bouncing_mass) {
  const Bouncer bouncer;
  SwitchingMotion motion(bouncer.scene());
  BOOST_TEST_REQUIRE(motion.advance(1));
  const double fall = bouncer.fall(), taut = bouncer.taut();
  const std::vector<double> expected = {fall, fall + taut, 3 * fall + taut};
  BOOST_TEST_REQUIRE(motion.changes().size() == expected.size() - (expected.back() > 1));
  // The closed form is rounded to double.
  for (std::size_t i = 0; i < motion.changes().size(); ++i)
    BOOST_TEST(std::abs(static_cast<double>(motion.changes()[i].t) - expected[i]) < 1e-15);
}

BOOST_AUTO_TEST_CASE(the_integrator_finds_where_a_spring_breaks) {
  const Bouncer bouncer;
  Scene scene = bouncer.scene();
  scene.springs[0].law.breaks_at = 0.12;
  SwitchingMotion motion(scene);
  const double before = static_cast<double>(motion.energy());
  BOOST_TEST_REQUIRE(motion.advance(1));
  BOOST_TEST_REQUIRE(motion.changes().size() == 2u);
  const double w = std::sqrt(bouncer.k), low = bouncer.g / bouncer.k;
  const double v = bouncer.g * bouncer.fall(), amplitude = std::hypot(low, v / w);
  const double expected =
      bouncer.fall() + (std::atan2(v / w, -low) - std::acos((0.12 - low) / amplitude)) / w;
  // Rounded to double; 1/2 k (0.12 m)^2 is 2.88 J.
  BOOST_TEST(std::abs(static_cast<double>(motion.changes()[1].t) - expected) < 1e-15);
  BOOST_TEST(std::abs(static_cast<double>(motion.released()) - 2.88) < 1e-14);
  const double after = static_cast<double>(motion.energy() + motion.released());
  BOOST_TEST(std::abs(after - before) < 1e-14);
}

BOOST_DATA_TEST_CASE(methods_move_scenes_with_cables, boost::unit_test::data::xrange(1, 26), seed) {
  const SwitchingScene drawn = SwitchingScenes(std::uint64_t(seed)).draw();
  BOOST_TEST_CONTEXT(drawn.kind) { BOOST_TEST(disagreements(drawn.scene) == ""); }
}

BOOST_DATA_TEST_CASE(methods_move_scenes_with_springs_that_break,
                     boost::unit_test::data::xrange(1, 16), seed) {
  const SwitchingScene drawn = SwitchingScenes(std::uint64_t(seed)).draw_breaking();
  BOOST_TEST_CONTEXT(drawn.kind) { BOOST_TEST(disagreements(drawn.scene) == ""); }
}

BOOST_AUTO_TEST_SUITE_END()
