// Mirrors of parts that are large enough for a sample of nodes to be asked first.
#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(sampled_mirrors)

using namespace qddot;

namespace {

// 60 by 60 nodes: every third is in the sample.
Scene cloth() { return draw("cloth", {{"nodes", 60}}); }

int mirrors(const Scene& scene) { return Model(scene).parts().front().mirrors().count; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_mirror_that_fits_all_nodes_is_found) {
  BOOST_TEST(mirrors(cloth()) == 1);
  BOOST_TEST(mirrors(turned(cloth(), some_rotation(), {1, 2, 3})) == 1);
}

BOOST_AUTO_TEST_CASE(one_node_or_spring_that_differs_takes_it_whether_it_is_in_the_sample_or_not) {
  for (const std::size_t node : {1570u, 1571u, 1572u, 1573u, 1574u, 1575u}) {
    BOOST_TEST_CONTEXT("node " << node) {
      Scene scene = cloth();
      scene.nodes[node].position.z() += 1e-6;
      BOOST_TEST(mirrors(scene) == 0);
      scene = cloth();
      scene.nodes[node].velocity.y() = 1e-6;
      BOOST_TEST(mirrors(scene) == 0);
      scene = cloth();
      scene.nodes[node].mass *= 1 + 1e-9;
      BOOST_TEST(mirrors(scene) == 0);
      scene = cloth();
      scene.nodes[node].load = {0, 0, 1e-6};
      BOOST_TEST(mirrors(scene) == 0);
      scene = cloth();
      scene.nodes[node].pinned = true;
      BOOST_TEST(mirrors(scene) == 0);
    }
  }
  for (const std::size_t spring : {0u, 5000u, 9001u, 15000u}) {
    Scene scene = cloth();
    scene.springs[spring].law.stiffness *= 1 + 1e-9;
    BOOST_TEST(mirrors(scene) == 0, "spring " << spring);
    scene = cloth();
    scene.springs.erase(scene.springs.begin() + static_cast<std::ptrdiff_t>(spring));
    BOOST_TEST(mirrors(scene) == 0, "without spring " << spring);
  }
}

BOOST_AUTO_TEST_CASE(a_hub_of_many_springs_is_searched_as_a_node_of_few) {
  // Spokes from a hub, some doubled, in any order; two more of them at one angle than at its image.
  std::mt19937 random(9);
  for (const int spokes : {6, 40, 400}) {
    for (const auto& [is_whole, is_doubled] :
         {std::pair(true, true), {true, false}, {false, true}, {false, false}}) {
      Scene scene{.dimension = 2};
      scene.nodes.push_back({.mass = 1});
      for (int i = 0; i < spokes; ++i) {
        const double angle = (i / 2 + 0.3) * M_PI / spokes;
        scene.nodes.push_back(
            {.position = {std::cos(angle) * (i % 2 ? 1 : -1), 2 * std::sin(angle), 0}, .mass = 1});
        const auto end = static_cast<std::size_t>(i + 1);
        scene.springs.push_back({{0, end}, {10, 1}});
        if (is_doubled && i / 2 % 3 == 0) scene.springs.push_back({{end, 0}, {7, 0.5}});
      }
      std::ranges::shuffle(scene.springs, random);
      if (!is_whole) scene.springs[random() % scene.springs.size()].law.stiffness *= 2;
      BOOST_TEST(mirrors(scene) == (is_whole ? 1 : 0), spokes << (is_whole ? "" : ", one differs"));
    }
  }
}

BOOST_AUTO_TEST_CASE(places_that_differ_by_rounding_keep_it) {
  Scene scene = cloth();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> rounding(-4 * 0x1p-52, 4 * 0x1p-52);
  for (Node& node : scene.nodes)
    node.position += Eigen::Vector3d(rounding(random), rounding(random), 0);
  BOOST_TEST(mirrors(scene) == 1);
}

BOOST_AUTO_TEST_SUITE_END()
