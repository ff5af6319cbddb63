// Large meshes whose nodes are numbered at random are numbered along their springs, and nothing
// else changes.
#include <numeric>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/model.hpp"
#include "qddot/scene/reduce/drawn_part.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(node_order)

using namespace qddot;
using namespace qddot::reduce;

namespace {

constexpr int side = 150;  // of a grid of more than the fewest nodes that are numbered anew

std::vector<std::size_t> shuffled(std::size_t count) {
  std::vector<std::size_t> number(count);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(5));
  return number;
}

DrawnPart whole(const Scene& scene) {
  return drawn_part(std::move(joined(parts_of(scene.nodes, scene.springs)).front()), scene.nodes,
                    scene.springs, scene);
}

double mean_distance(const DrawnPart& part) {
  double sum = 0;
  for (int e = 0; e < part.springs.size(); ++e)
    sum += std::abs(part.springs.ends(e)[0] - part.springs.ends(e)[1]);
  return sum / part.springs.size();
}

// Whether the part has all springs of the scene, in their order and between the same nodes.
bool has_springs_of(const DrawnPart& part, const Scene& scene) {
  if (part.springs.size() != std::ssize(scene.springs)) return false;
  for (int e = 0; e < part.springs.size(); ++e) {
    const auto [a, b] = part.springs.ends(e);
    const std::array<std::size_t, 2> nodes = {part.nodes[static_cast<std::size_t>(a)],
                                              part.nodes[static_cast<std::size_t>(b)]};
    const auto& drawn = scene.springs[static_cast<std::size_t>(e)].nodes;
    if (nodes[0] != drawn[0] || nodes[1] != drawn[1]) return false;
  }
  return true;
}

}  // namespace

BOOST_AUTO_TEST_CASE(scattered_nodes_of_a_large_part_are_numbered_along_its_springs) {
  const Scene grid = draw("cloth", {{"nodes", side}});
  const Scene scattered = renumbered(grid, shuffled(grid.nodes.size()));
  const DrawnPart part = whole(scattered);
  // A row has `side` nodes; levels of a breadth-first search are diagonals, and springs may pass
  // one.
  BOOST_TEST(mean_distance(part) < 3 * side);
  BOOST_TEST(has_springs_of(part, scattered));
  BOOST_TEST(has_springs_of({.nodes = part.nodes,
                             .free = part.free,
                             .springs = drawn_springs(part, scattered.nodes, scattered.springs)},
                            scattered));
  std::vector<std::size_t> free(part.nodes.begin(),
                                part.nodes.begin() + static_cast<std::ptrdiff_t>(part.free));
  BOOST_TEST(!std::ranges::is_sorted(free));
  std::ranges::sort(free);
  BOOST_TEST((std::ranges::adjacent_find(free) == free.end()));
  BOOST_TEST(free.size() == grid.nodes.size() - 2);  // two are pinned
  for (std::size_t i = 0; i < part.free; ++i) {
    BOOST_REQUIRE(!scattered.nodes[part.nodes[i]].pinned);
    BOOST_REQUIRE((part.x[i] + part.origin == scattered.nodes[part.nodes[i]].position));
  }
}

BOOST_AUTO_TEST_CASE(pieces_and_single_nodes_keep_their_number) {
  // Two grids and loose nodes, as one part.
  Scene scene = draw("cloth", {{"nodes", side}});
  const std::size_t count = scene.nodes.size();
  scene.nodes.insert(scene.nodes.end(), scene.nodes.begin(), scene.nodes.end());
  for (std::size_t e = 0, springs = scene.springs.size(); e < springs; ++e) {
    Spring copy = scene.springs[e];
    for (std::size_t& node : copy.nodes) node += count;
    scene.springs.push_back(copy);
  }
  for (int i = 0; i < 10; ++i) scene.nodes.push_back({.mass = 1});
  const Scene scattered = renumbered(scene, shuffled(scene.nodes.size()));
  const DrawnPart part = whole(scattered);
  BOOST_TEST(mean_distance(part) < 3 * side);
  BOOST_TEST(has_springs_of(part, scattered));
  BOOST_TEST(part.free == scene.nodes.size() - 4);
}

BOOST_AUTO_TEST_CASE(orderly_and_small_parts_stay_as_they_are) {
  const Scene grid = draw("cloth", {{"nodes", side}}),
              block = draw("lattice", {{"nodes_x", 30}, {"nodes_y", 30}, {"nodes_z", 30}}),
              small = draw("cloth", {{"nodes", 50}});
  for (const Scene& scene : {grid, block, renumbered(small, shuffled(small.nodes.size()))}) {
    const DrawnPart part = whole(scene);
    BOOST_TEST(std::is_sorted(part.nodes.begin(),
                              part.nodes.begin() + static_cast<std::ptrdiff_t>(part.free)));
  }
}

BOOST_AUTO_TEST_CASE(a_scattered_mesh_moves_as_the_orderly_one) {
  const Scene grid = draw("cloth", {{"nodes", side}});
  const std::vector<std::size_t> number = shuffled(grid.nodes.size());
  const Scene scattered = renumbered(grid, number);
  constexpr int steps = 40;
  constexpr double h = 2e-5;  // [s]
  const auto end = [&](const Scene& scene, const Reductions& reductions) {
    const Model model(scene, reductions);
    const System& system = model.system();
    State state = model.initial();
    Vec f(system.size());
    for (int step = 0; step < steps; ++step) {
      system.force(state, f);
      state.v += h * f.cwiseQuotient(system.mass());
      state.q += h * state.v;
    }
    return model.expand(state);
  };
  for (const Reductions& reductions : {Reductions(), Reductions().without(Reduction::mirror)}) {
    const std::vector<Node> expected = end(grid, reductions), found = end(scattered, reductions);
    double most = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
      most = std::max(most, (found[number[i]].position - expected[i].position).norm());
    // Forces are sums in another order in each step.
    BOOST_TEST(most < 10 * steps * eps);
  }
}

BOOST_AUTO_TEST_SUITE_END()
