// The motion of a scene in a plane, on a line or in its mirrors is that of the scene in space.
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "tests/independent/random_scene.hpp"
#include "tests/integrators/scenes.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(reduced_motion)

using namespace qddot;

namespace {

std::vector<Node> end_of(const Scene& scene, const Reductions& reductions) {
  return nodes_after(scene, reductions, method_named("kahan_li8"), 1e-3, 0.5);
}

Scene rotated(const Scene& scene) { return turned(scene, some_rotation(), {1, 2, 3}); }

void check_motion(const Scene& scene, Reduction reduction) {
  BOOST_TEST(has(Model(scene), reduction));
  const auto reduced = end_of(scene, {}), drawn = end_of(scene, Reductions().without(reduction));
  // Rounding of the positions in 500 steps, relative to the largest displacement: these motions are
  // regular and magnify it by less than a hundred.
  BOOST_TEST(farthest(reduced, drawn) / farthest(reduced, scene.nodes) < 1e-10);
}

}  // namespace

BOOST_AUTO_TEST_CASE(motions_in_a_plane_or_on_a_line_are_those_in_space) {
  const auto chain = [](int nodes) {
    return draw("chain", {{"nodes", nodes}, {"stiffness", 1e4}});
  };
  for (const Scene& scene : {chain(12), draw("orbit"), draw("pair"), rotated(chain(6)),
                             rotated(draw("pendulum", {{"speed", 0}}))}) {
    check_motion(scene, Reduction::dimension);
  }
}

BOOST_AUTO_TEST_CASE(a_motion_is_its_own_mirror_image) {
  const Scene odd = draw("cloth", {{"nodes", 7}}), even = draw("cloth", {{"nodes", 8}}),
              lattice = draw("lattice",
                             {{"nodes_x", 4}, {"nodes_y", 3}, {"nodes_z", 2}, {"stiffness", 500}});
  for (const Scene& scene :
       {odd, even, lattice, rotated(odd), square(), square(3), rotated(square())}) {
    check_motion(scene, Reduction::mirror);
  }
}

BOOST_AUTO_TEST_CASE(implicit_steps_are_the_same_too) {
  const Scene cloth = draw("cloth", {{"nodes", 7}});
  for (const char* name : {"implicit_euler", "semi_implicit_euler"}) {
    const auto end = [&](const Reductions& reductions) {
      return nodes_after(cloth, reductions, method_named(name), 5e-3, 0.1);
    };
    // Solved to 1e-12 of a step.
    const double apart = farthest(end({}), end(Reductions::only({})));
    BOOST_TEST(apart / farthest(end({}), cloth.nodes) < 1e-9, name);
  }
}

BOOST_AUTO_TEST_CASE(unknowns_tell_how_far_nodes_are_apart) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  int seen = 0, with_mirrors = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const auto [scene, kind] = random_scene(seed);
    const Model reduced(scene);
    const auto parts = reduced.nodes_by_part();
    State here = reduced.initial(), there = here;
    for (double& q : there.q) q += normal(random);
    for (double& v : there.v) v = normal(random);
    const auto apart = reduced.largest_by_part(there.q - here.q),
               speeds = reduced.largest_by_part(there.v);
    // Springs in series are one spring, whose joints are no unknowns.
    const bool has_joints = has(reduced, Reduction::massless);
    BOOST_TEST(apart.size() == (has_joints ? 0 : parts.size()), kind << ", seed " << seed);
    if (apart.empty()) continue;
    const auto a = reduced.expand_beside_falls(here), b = reduced.expand_beside_falls(there);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      double distance = 0, speed = 0, extent = 1;
      for (const std::size_t i : parts[p]) {
        distance = std::max(distance, (b[i].position - a[i].position).norm());
        speed = std::max(speed, b[i].velocity.norm());
        extent = std::max(extent, b[i].position.norm());
      }
      // Rotations and sums round some times.
      BOOST_TEST(std::abs(apart[p] - distance) <= 16 * 0x1p-52 * extent, kind << ", seed " << seed);
      BOOST_TEST(std::abs(speeds[p] - speed) <= 16 * 0x1p-52 * speed, kind << ", seed " << seed);
      with_mirrors += reduced.parts()[p].mirrors().count > 0;
      ++seen;
    }
  }
  BOOST_TEST(seen > 1000, seen);
  BOOST_TEST(with_mirrors > 100, with_mirrors);
}

BOOST_AUTO_TEST_SUITE_END()
