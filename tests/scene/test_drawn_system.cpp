// The forces of a scene as drawn, over the coordinates of all nodes.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/drawn_system.hpp"
#include "tests/fragments.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(drawn_system)

using namespace qddot;

BOOST_AUTO_TEST_CASE(forces_are_those_of_the_drawn_springs_and_pins_are_held) {
  for (const Generator& generator : generators()) {
    const Scene scene = draw(generator.name);
    const auto system = qddot::drawn_system(scene);
    const Index d = scene.dimension;
    BOOST_TEST_REQUIRE(system->size() == d * std::ssize(scene.nodes));
    Vec q(system->size()), expected(system->size());
    for (Index i = 0; i < std::ssize(scene.nodes); ++i) {
      const Node& node = scene.nodes[static_cast<std::size_t>(i)];
      q.segment(d * i, d) = node.position.head(d);
      expected.segment(d * i, d) = node.mass * scene.gravity.head(d);
    }
    for (const Spring& spring : scene.springs) {
      const auto [a, b] = spring.nodes;
      const Eigen::Vector3d along = scene.nodes[b].position - scene.nodes[a].position;
      const double length = along.norm();
      const Vec pull = (spring.law.tension(length) / length * along).head(d);
      expected.segment(d * static_cast<Index>(a), d) += pull;
      expected.segment(d * static_cast<Index>(b), d) -= pull;
    }
    for (Index i = 0; i < std::ssize(scene.nodes); ++i) {
      if (scene.nodes[static_cast<std::size_t>(i)].pinned) expected.segment(d * i, d).setZero();
    }
    // Sums in another order: some roundings of the stiffest spring's k l for each of few springs.
    double largest = 0;
    for (const Spring& spring : scene.springs) {
      largest = std::max(largest, spring.law.stiffness * q.lpNorm<Eigen::Infinity>());
    }
    const double off = (force_at(*system, q) - expected).lpNorm<Eigen::Infinity>();
    BOOST_TEST(off <= 100 * eps * largest, generator.name << ": " << off);
  }
}

BOOST_AUTO_TEST_SUITE_END()
