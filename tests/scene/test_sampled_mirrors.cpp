// Mirrors of parts that are large enough for a sample of nodes to be asked first.
#include <boost/test/unit_test.hpp>

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

BOOST_AUTO_TEST_CASE(places_that_differ_by_rounding_keep_it) {
  Scene scene = cloth();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> rounding(-4 * 0x1p-52, 4 * 0x1p-52);
  for (Node& node : scene.nodes)
    node.position += Eigen::Vector3d(rounding(random), rounding(random), 0);
  BOOST_TEST(mirrors(scene) == 1);
}

BOOST_AUTO_TEST_SUITE_END()
