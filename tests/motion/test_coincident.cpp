// Mirrors of scenes in which nodes coincide: every node moves, and as it does in the scene as
// drawn.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "tests/independent/comparison.hpp"
#include "tests/independent/random_scene.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(coincident)

using namespace qddot;

namespace {

// A grid of n x n nodes drawn twice, sewn together by springs of no length, and stretched.
Scene two_layers(int n, bool numbers_alternate) {
  Scene scene{.dimension = 2};
  const auto number = [&](int layer, int i, int j) {
    const int place = n * i + j;
    const bool is_turned = numbers_alternate && (i * j + i + j) % 3 == 0;
    return static_cast<std::size_t>(2 * place + (is_turned ? 1 - layer : layer));
  };
  scene.nodes.resize(static_cast<std::size_t>(2 * n * n));
  for (int layer = 0; layer < 2; ++layer) {
    // Unlike springs, so that no layer is the other's image.
    const double k = layer == 0 ? 50 : 80;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        scene.nodes[number(layer, i, j)] = {.position = {0.1 * i, 0.1 * j, 0}, .mass = 0.02};
        if (i > 0)
          scene.springs.push_back({{number(layer, i, j), number(layer, i - 1, j)}, {k, 0.09}});
        if (j > 0)
          scene.springs.push_back({{number(layer, i, j), number(layer, i, j - 1)}, {k, 0.09}});
        if (layer == 0) scene.springs.push_back({{number(0, i, j), number(1, i, j)}, {30, 0}});
      }
    }
  }
  return scene;
}

// Checks that all nodes are where they are drawn. Energies and forces must be those of the drawn
// nodes, at the start and near it.
void check_all(const Scene& scene) {
  const Model reduced(scene);
  // Tolerances of mirrors, 64 eps, and turning there and back.
  BOOST_TEST(farthest(reduced.expand(reduced.initial()), at_start(scene)) < 1e3 * eps);
  for (const std::string& sentence : compare_states(scene, 1).disagreements) BOOST_ERROR(sentence);
  for (const Finding& finding : reduced.findings()) {
    BOOST_TEST(finding.what.find("defect") == std::string::npos, finding.what);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(layers_of_a_grid_keep_all_of_their_mass) {
  for (const int n : {3, 4, 5, 6, 7}) {
    for (const bool numbers_alternate : {false, true}) {
      const Scene scene = two_layers(n, numbers_alternate);
      BOOST_TEST_CONTEXT(n << " by " << n) {
        check_all(scene);
        const Model reduced(scene);
        BOOST_TEST(reduced.parts().front().mirrors().count == 2);
        // Both layers of a quarter; those on a mirror have one coordinate, the middle has none.
        BOOST_TEST(reduced.system().size() == 2 * (n / 2) * (n / 2) * 2 + n % 2 * 2 * 2 * (n / 2));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(whatever_coincides_moves_as_drawn) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const auto [scene, kind] = random_scene(seed);
    if (kind != "mirrored" && kind != "coincident") continue;
    BOOST_TEST_CONTEXT(kind << ", seed " << seed) {
      check_all(scene);
      const Model reduced(scene);
      for (const qddot::reduce::Part& part : reduced.parts()) found += part.mirrors().count;
    }
  }
  BOOST_TEST(found > 300, found);
}

BOOST_AUTO_TEST_CASE(twins_that_nothing_tells_apart_are_swapped_by_mirrors_that_commute) {
  // Two nodes at each corner of a rectangle, each on springs to both of either side: any of two may
  // be the image. They are in one place up to rounding, so that no order decides.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> rounding_of(-4 * eps, 4 * eps);
  for (int draw = 0; draw < 20; ++draw) {
    Scene scene{.dimension = 2};
    for (const auto& [x, y] : {std::pair(1., 2.), {-1., 2.}, {-1., -2.}, {1., -2.}}) {
      for (int twin = 0; twin < 2; ++twin) {
        scene.nodes.push_back(
            {.position = {x + rounding_of(random), y + rounding_of(random), 0}, .mass = 1});
      }
    }
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t next = (i / 2 + 1) % 4 * 2;
      for (const std::size_t j : {next, next + 1}) scene.springs.push_back({{i, j}, {30, 1.5}});
    }
    check_all(scene);
    const Model reduced(scene);
    BOOST_TEST(reduced.parts().front().mirrors().count == 2);
    BOOST_TEST(reduced.system().size() == 4);
  }
}

BOOST_AUTO_TEST_CASE(a_ring_that_winds_twice_has_one_mirror) {
  // Node i at corner i mod 4, springs from i to i + 1 mod 8. The images under one mirror are 1 - i
  // or 5 - i, under the other 3 - i or 7 - i. Both mirrors in turn give i - 2 or i + 2; the other
  // order gives i + 2 or i - 2.
  Scene scene{.dimension = 2};
  const std::vector<std::pair<double, double>> corners = {{1, 2}, {-1, 2}, {-1, -2}, {1, -2}};
  for (std::size_t i = 0; i < 8; ++i) {
    const auto [x, y] = corners[i % 4];
    scene.nodes.push_back({.position = {x, y, 0}, .mass = 1});
    scene.springs.push_back({{i, (i + 1) % 8}, {30, 1.5}});
  }
  check_all(scene);
  const Model reduced(scene);
  BOOST_TEST(reduced.parts().front().mirrors().count == 1);
}

BOOST_AUTO_TEST_CASE(a_spring_as_short_as_rounding_has_no_mirror) {
  // Its ends, apart by one rounding, fly apart along the diagonal.
  Scene scene{.dimension = 2};
  scene.nodes = {{.position = {1e-17, 1e-17, 0}, .mass = 1},
                 {.position = {-1e-17, -1e-17, 0}, .mass = 1},
                 {.position = {1, 0, 0}, .mass = 1},
                 {.position = {-1, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {100, 1}}};
  for (const std::size_t i : {0u, 1u}) {
    for (const std::size_t j : {2u, 3u}) scene.springs.push_back({{i, j}, {10, 0}});
  }
  check_all(scene);
}

BOOST_AUTO_TEST_SUITE_END()
