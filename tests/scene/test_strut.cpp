#include <boost/test/unit_test.hpp>

#include "qddot/analysis/natural_modes.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(strut)

using namespace qddot;

namespace {

double squared_sine(int j, int n) { return std::pow(std::sin(j * M_PI / (2 * (n + 1))), 2); }

}  // namespace

BOOST_AUTO_TEST_CASE(springs_are_compressed_as_asked_and_the_column_is_bent) {
  const Scene scene = draw("strut", {{"nodes", 9},
                                     {"length", 2},
                                     {"compression", 0.8},
                                     {"bend", 0.03},
                                     {"mass", 3},
                                     {"stiffness", 70}});
  BOOST_TEST(scene.dimension == 2);
  BOOST_TEST(scene.gravity.norm() == 0);
  BOOST_TEST_REQUIRE(scene.nodes.size() == 9u);
  BOOST_TEST(scene.springs.size() == 8u);
  for (std::size_t i = 0; i < 9; ++i) {
    const Node& node = scene.nodes[i];
    const double x = 0.25 * static_cast<double>(i);
    const Eigen::Vector3d bent(x, 0.03 * std::sin(M_PI * x / 2), 0);
    BOOST_TEST(distance(node.position, bent) < 1e-16);  // of the sine at the end
    BOOST_TEST(node.velocity.norm() == 0);
    BOOST_TEST(node.pinned == (i == 0 || i == 8));
    BOOST_TEST(node.mass == 3);
  }
  BOOST_TEST(scene.nodes.back().position.y() == 0);
  for (const Spring& spring : scene.springs) {
    BOOST_TEST(spring.law.stiffness == 70);
    BOOST_TEST(std::abs(spring.law.rest_length - 0.25 / 0.8) < 1e-15);
  }
}

// All w^2 at once: N of waves along the column and, negative, N of its growth across.
BOOST_AUTO_TEST_CASE(straight_it_buckles_at_the_rates_of_the_closed_form) {
  for (const int nodes : {3, 4, 12, 33}) {
    for (const double compression : {0.5, 0.9, 0.999, 1.0}) {
      const double k = 500, m = 0.2;
      const Scene scene = draw("strut", {{"nodes", nodes},
                                         {"compression", compression},
                                         {"bend", 0},
                                         {"stiffness", k},
                                         {"mass", m}});
      const Model reduced(scene, Reductions::all_directions());
      const int n = nodes - 2;
      BOOST_TEST_REQUIRE(reduced.system().size() == 2 * n);
      Vec expected(2 * n);
      for (int j = 1; j <= n; ++j) {
        expected[j - 1] = -4 * k / m * (1 / compression - 1) * squared_sine(n + 1 - j, n);
        expected[n + j - 1] = 4 * k / m * squared_sine(j, n);
      }
      const NaturalModes modes = lowest_modes(reduced.system(), reduced.initial().q, 2 * n);
      // Right to some 1e-15 of the largest.
      BOOST_TEST(distance(modes.squares, expected) < 1e-13 * 4 * k / m);
    }
  }
}

BOOST_AUTO_TEST_CASE(straight_and_bent_it_is_its_own_mirror_image) {
  for (const double bend : {0., 1e-3, 0.2}) {
    const Model reduced(draw("strut", {{"bend", bend}}));
    BOOST_TEST(has(reduced, Reduction::mirror));
    BOOST_TEST(has(reduced, Reduction::dimension) == (bend == 0));
    // Five of ten free nodes, in the plane or on the line.
    BOOST_TEST(reduced.system().size() == (bend == 0 ? 5 : 10));
  }
}

BOOST_AUTO_TEST_SUITE_END()
