// A reduced part is told from one that was drawn otherwise: what every reduction is checked by.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/as_drawn.hpp"
#include "qddot/scene/reduce/part.hpp"
#include "tests/fragments.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(as_drawn)

using namespace qddot;
using namespace qddot::reduce;

namespace {

DrawnPart drawn_part(const Scene& scene) {
  return reduce::drawn_part(joined(parts_of(scene.nodes, scene.springs)).front(), scene.nodes,
                            scene.springs, scene);
}

template <class Change>
std::string difference(const Scene& scene, const Change& change) {
  Part part(drawn_part(scene), scene.dimension, Reductions());
  part.make_system();
  Scene other = scene;
  change(other);
  const DrawnPart drawn = drawn_part(other);
  return part.difference_from(drawn, DrawnEnergies(drawn)).value_or("");
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_part_is_the_drawn_one_that_it_was_made_of) {
  for (const Generator& generator : generators()) {
    const Scene scene = draw(generator.name);
    BOOST_TEST(difference(scene, [](Scene&) {}) == "", generator.name);
    if (scene.dimension > 1) {
      const Scene tilted = turned(scene, some_rotation(), {3, -2, 1});
      BOOST_TEST(difference(tilted, [](Scene&) {}) == "", generator.name);
    }
  }
}

BOOST_AUTO_TEST_CASE(whatever_is_lost_or_changed_is_found) {
  const Scene cloth = draw("cloth", {{"nodes", 5}});
  const auto is_told = [](const Scene& drawn, const std::string& words, const auto& change) {
    return contains(difference(drawn, change), {words});
  };
  BOOST_TEST(is_told(cloth, "a mass would be", [](Scene& s) { s.nodes[7].mass *= 1 + 1e-12; }));
  BOOST_TEST(is_told(cloth, "nodes would move", [](Scene& s) { s.nodes[7].pinned = true; }));
  BOOST_TEST(is_told(cloth, "from its place", [](Scene& s) { s.nodes[7].position.y() += 1e-11; }));
  BOOST_TEST(is_told(cloth, "velocity off by", [](Scene& s) { s.nodes[7].velocity.y() += 1e-11; }));
  const std::string energy = "potential energy";
  BOOST_TEST(is_told(cloth, energy, [](Scene& s) { s.springs[3].law.rest_length *= 0.9; }));
  const Spring more{{0, 24}, {1, 0}};
  BOOST_TEST(is_told(cloth, energy, [&](Scene& s) { s.springs.push_back(more); }));
  const Scene tilted = turned(cloth, some_rotation(), {0, 0, 1});
  BOOST_TEST(is_told(tilted, energy, [](Scene& s) { s.gravity *= 1.001; }));
}

BOOST_AUTO_TEST_CASE(what_underflows_is_no_difference) {
  // 1/2 m |v|^2 is nothing if halved first, and a multiple of the smallest number if not.
  Scene light = turned(draw("cloth", {{"nodes", 4}}), some_rotation(), {0, 0, 1});
  for (Node& node : light.nodes) {
    node.mass = 0x1p-1074;
    node.velocity = {-0.344, -0.577, 0.627};
  }
  for (Spring& spring : light.springs) spring.law.stiffness = 0x1p-1074;
  for (const Reductions& set : {Reductions(), Reductions::only({})})
    BOOST_CHECK_NO_THROW(Model(light, set));
}

BOOST_AUTO_TEST_CASE(lines_and_planes_are_named_by_what_they_are) {
  const auto sentence = [](const Scene& scene) {
    return tests::sentence(Model(scene), Reduction::dimension);
  };
  // A pair that swings along the line from (1, 2) to (4, 6).
  Scene pair{.dimension = 2};
  pair.nodes = {{.position = {1, 2, 0}, .mass = 1}, {.position = {4, 6, 0}, .mass = 2}};
  pair.springs = {{{0, 1}, {10, 4}}};
  BOOST_TEST(contains(sentence(pair), {"line along (0.6, 0.8) through (1, 2)"}), sentence(pair));
  // Far away the place is still the scene's.
  for (Node& node : pair.nodes) node.position += Eigen::Vector3d(1000, 2000, 0);
  BOOST_TEST(contains(sentence(pair), {"through (1001, 2002)"}), sentence(pair));
  for (Node& node : pair.nodes) node.position.y() = 2000;
  BOOST_TEST(contains(sentence(pair), {"in the line y = 2000:"}), sentence(pair));
  for (Node& node : pair.nodes) std::swap(node.position.x(), node.position.y());
  BOOST_TEST(contains(sentence(pair), {"in the line x = 2000:"}), sentence(pair));
  BOOST_TEST(contains(sentence(turned(draw("chain"), Eigen::Matrix3d::Identity(), {0, 0, 0.5})),
                      {"plane "}));
}

BOOST_AUTO_TEST_SUITE_END()
