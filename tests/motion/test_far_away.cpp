// A scene's motion does not depend on its place. Tolerances, rounding and energies scale with its
// size and not with its distance from the origin.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(far_away)

using namespace qddot;

namespace {

// Moved by whole numbers and as if drawn there: the coordinates that it has then, and here.
struct Pair {
  Scene here, there;
};
Pair moved_by(Scene scene, const Eigen::Vector3d& shift) {
  Pair pair{scene, scene};
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    Eigen::Vector3d& there = pair.there.nodes[i].position;
    there += shift;
    pair.here.nodes[i].position = there - shift;  // exact (Sterbenz), or nearly so
  }
  return pair;
}

// Compressed, along the diagonal; its middle is `off` it in each coordinate.
Scene strut(double off) {
  Scene scene{.dimension = 2};
  for (int i = 0; i < 3; ++i) {
    const double at = 0.625 * i, beside = i == 1 ? off : 0;
    scene.nodes.push_back({.position = {at - beside, at + beside, 0}, .mass = 1, .pinned = i != 1});
  }
  scene.springs = {{{0, 1}, {1000, 1}}, {{1, 2}, {1000, 1}}};
  return scene;
}

const Eigen::Vector3d shift(1048576, -524288, 2097152);  // 2^20 and neighbours [m]

}  // namespace

BOOST_AUTO_TEST_CASE(a_deviation_far_above_the_local_rounding_breaks_planes_and_mirrors) {
  // The last bit at a million metres, 2^-32 m, is 10^6 times the rounding of a metre.
  const Eigen::Vector3d by(shift.x(), shift.y(), 0);
  BOOST_TEST(has(Model(moved_by(strut(0), by).there), Reduction::dimension));
  for (const double off : {0x1p-32, 0x1p-28}) {
    const auto [here, there] = moved_by(strut(off), by);
    BOOST_TEST(!has(Model(here), Reduction::dimension));
    BOOST_TEST(!has(Model(there), Reduction::dimension));
  }
  Scene cloth = draw("cloth", {{"nodes", 6}});
  for (Node& node : cloth.nodes) {  // places that a shift does not round
    for (double& x : node.position) x = std::round(x * 0x1p20) / 0x1p20;
  }
  for (Spring& spring : cloth.springs) spring.law.rest_length = 0.1;
  cloth = moved_by(cloth, shift).there;
  BOOST_TEST(has(Model(cloth), Reduction::mirror));
  cloth.nodes[8].position.x() += 0x1p-32;
  BOOST_TEST(!has(Model(cloth), Reduction::mirror));
}

BOOST_AUTO_TEST_CASE(the_reduced_system_is_bit_for_bit_that_of_the_scene_at_home) {
  for (const Scene& scene : {draw("chain", {{"nodes", 6}}), draw("cloth", {{"nodes", 4}}), square(),
                             draw("pair"), draw("orbit")}) {
    const Eigen::Vector3d by = scene.dimension == 3   ? shift
                               : scene.dimension == 2 ? Eigen::Vector3d(shift.x(), shift.y(), 0)
                                                      : Eigen::Vector3d(shift.x(), 0, 0);
    // `here` is relative to the first free node, as `there` is.
    const Scene there = moved_by(scene, by).there;
    Scene here = there;
    std::size_t first = 0;
    while (here.nodes[first].pinned) ++first;
    for (Node& node : here.nodes) node.position -= there.nodes[first].position;
    for (const Reductions& reductions :
         {Reductions(), Reductions::only({}), Reductions::only({Reduction::pins}),
          Reductions().without(Reduction::dimension).without(Reduction::mirror)}) {
      const Model a(here, reductions), b(there, reductions);
      BOOST_TEST_REQUIRE(a.initial().q.size() == b.initial().q.size());
      BOOST_TEST((a.initial().q == b.initial().q));
      BOOST_TEST((a.initial().v == b.initial().v));
      BOOST_TEST(a.system().potential(a.initial().q) == b.system().potential(b.initial().q));
      // And the way back is exact.
      const auto nodes = b.expand(b.initial());
      if (b.parts().front().mirrors().count > 0) continue;  // images may be off by their tolerance
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        BOOST_TEST((nodes[i].position == there.nodes[i].position));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(scenes_that_lie_about_the_origin_keep_their_coordinates) {
  for (const Generator& generator : generators()) {
    const Model reduced(draw(std::string(generator.name)));
    for (const qddot::reduce::Part& part : reduced.parts()) {
      BOOST_TEST((part.origin() == Eigen::Vector3d::Zero()), generator.name);
    }
  }
}

BOOST_AUTO_TEST_CASE(weights_count_from_the_scenes_origin) {
  const Scene cloth = moved_by(draw("cloth", {{"nodes", 5}}), shift).there;
  const Model reduced(cloth);
  const double v = potential_by_hand(cloth, cloth.nodes);
  // 25 weights at a million metres and more, each rounded.
  BOOST_TEST(std::abs(reduced.potential(reduced.initial()) - v) <= 100 * eps * std::abs(v));
  // The potential that changes in a motion is the system's, which does not contain the place.
  BOOST_TEST(std::abs(reduced.system().potential(reduced.initial().q)) < 1e-3 * std::abs(v));
}

BOOST_AUTO_TEST_SUITE_END()
