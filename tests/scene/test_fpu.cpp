#include <boost/test/unit_test.hpp>

#include "qddot/scene/stiff_energies.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(fpu)

using namespace qddot;

namespace {

// Displacements q_i = x_i - 10 i of up to 1 m, from positions of up to 70 m, have errors of some 70
// eps = 2e-14. Elongations of stiff springs, 1/w, so give energies an error of k 1/w 2e-14 = w/2
// 2e-14 J. That is less than this for w up to 100.
constexpr double tolerance = 1e-12;

}  // namespace

// Their H has w^2/4 (q_2i - q_2i-1)^2 for a stiff spring and (q_2i+1 - q_2i)^4 for a soft one, w =
// 50: k = w^2/2 and c = 4.
BOOST_AUTO_TEST_CASE(standard_is_that_of_hairer_lubich_and_wanner) {
  const Scene scene = draw("fpu");
  BOOST_TEST(scene.dimension == 1);
  BOOST_TEST(scene.gravity.norm() == 0);
  BOOST_TEST(*scene.until == 200);
  BOOST_TEST_REQUIRE(scene.nodes.size() == 8u);
  BOOST_TEST_REQUIRE(scene.springs.size() == 7u);
  for (std::size_t i = 0; i < 8; ++i) {
    BOOST_TEST(scene.nodes[i].mass == 1);
    BOOST_TEST(scene.nodes[i].pinned == (i == 0 || i == 7));
  }
  for (std::size_t e = 0; e < 7; ++e) {
    const Spring& spring = scene.springs[e];
    const bool stiff = e % 2 == 1;
    BOOST_TEST((spring.nodes == std::array<std::size_t, 2>{e, e + 1}));
    BOOST_TEST(spring.law.stiffness == (stiff ? 1250 : 0));
    BOOST_TEST(spring.law.rest_length == 10);
    BOOST_TEST(spring.law.quartic == (stiff ? 0 : 4));
    BOOST_TEST(is_stiff(spring.law, scene.stiff_above) == stiff);
  }
  BOOST_TEST((stiff_springs(scene) == std::vector<std::size_t>{1, 3, 5}));
}

BOOST_AUTO_TEST_CASE(it_starts_with_all_vibration_in_the_first_stiff_spring) {
  for (const double m : {1., 2., 3., 7.}) {
    for (const double w : {1., 7., 50., 100.}) {
      const Scene scene = draw("fpu", {{"stiff_springs", m}, {"frequency", w}});
      const Model reduced(scene);
      const Vec energies = stiff_energies(scene, scene.nodes);
      Vec expected = Vec::Zero(static_cast<Index>(m));
      expected[0] = 1;
      BOOST_TEST(distance(energies, expected) < tolerance);
      // The kinetic energy is 1. The stiff spring has 1/2, the soft ones beside it have ((1 -
      // 1/w)^4 + (1 + 1/w)^4)/4. The right one joins two walls' neighbours or, if m = 1, a wall.
      BOOST_TEST(std::abs(reduced.kinetic(reduced.initial()) - 1) < tolerance);
      const double h = 2 + 3 / (w * w) + 1 / (2 * std::pow(w, 4));
      BOOST_TEST(std::abs(reduced.energy(reduced.initial()) - h) < tolerance);
      // q and p are scaled coordinates.
      const auto q = [&](std::size_t i) { return scene.nodes[i].position.x() - 10. * double(i); };
      const auto p = [&](std::size_t i) { return scene.nodes[i].velocity.x(); };
      const double root = std::sqrt(2);
      BOOST_TEST(std::abs((q(2) + q(1)) / root - 1) < tolerance);
      BOOST_TEST(std::abs((q(2) - q(1)) / root - 1 / w) < tolerance);
      BOOST_TEST(std::abs((p(2) + p(1)) / root - 1) < tolerance);
      BOOST_TEST(std::abs((p(2) - p(1)) / root - 1) < tolerance);
      for (std::size_t i = 3; i < scene.nodes.size(); ++i) BOOST_TEST((q(i) == 0 && p(i) == 0));
    }
  }
}

BOOST_AUTO_TEST_CASE(reductions_leave_nothing_out_but_the_walls) {
  for (const double m : {1., 3.}) {
    const Scene scene = draw("fpu", {{"stiff_springs", m}});
    const Model reduced(scene);
    BOOST_TEST(reduced.system().size() == 2 * static_cast<Index>(m));
    BOOST_TEST(!reduced.system().stiffness_is_constant());
    BOOST_TEST_REQUIRE(reduced.findings().size() == 1u);
    BOOST_TEST((reduced.findings()[0].reduction == Reduction::pins));
    BOOST_TEST(reduced.massless_nodes().empty());
  }
}

BOOST_AUTO_TEST_SUITE_END()
