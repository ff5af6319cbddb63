// The motion of a reduced scene is that of the scene: all nodes, with each reduction and without.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "tests/integrators/scenes.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(reduced_motion)

using namespace qddot;

namespace {

// All nodes at time `until`, by a method of fixed step.
std::vector<Node> end_of(const Scene& scene, const Reductions& reductions, double until, double h,
                         const char* method = "kahan_li8") {
  return nodes_after(scene, reductions, method_named(method), h, until);
}

// The difference of the ends, relative to the largest displacement of a node.
double difference(const Scene& scene, const Reductions& one, const Reductions& other, double until,
                  double h, const char* method = "kahan_li8") {
  const auto a = end_of(scene, one, until, h, method);
  return farthest(a, end_of(scene, other, until, h, method)) / farthest(a, scene.nodes);
}

const Reductions all;
Reductions without(Reduction reduction) { return all.without(reduction); }

// The growth of rounding of the positions in 1e3 steps: these motions are regular and magnify it by
// less than a hundred.
constexpr double round_off = 1e-10;

}  // namespace

BOOST_AUTO_TEST_CASE(motions_in_a_plane_or_on_a_line_are_those_in_space) {
  for (const Scene& scene :
       {draw("chain", {{"nodes", 12}, {"stiffness", 1e4}}), draw("orbit"), draw("pair"),
        turned(draw("pendulum", {{"speed", 0}}), some_rotation(), {1, 2, 3}),
        turned(draw("chain", {{"nodes", 6}, {"stiffness", 1e4}}), some_rotation(), {1, 2, 3})}) {
    BOOST_TEST(has(ReducedScene(scene), Reduction::dimension));
    BOOST_TEST(difference(scene, all, without(Reduction::dimension), 0.5, 1e-3) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(a_motion_is_its_own_mirror_image) {
  for (const Scene& scene :
       {draw("cloth", {{"nodes", 7}}), draw("cloth", {{"nodes", 8}}),
        draw("lattice", {{"nodes_x", 4}, {"nodes_y", 3}, {"nodes_z", 2}, {"stiffness", 500}}),
        turned(draw("cloth", {{"nodes", 7}}), some_rotation(), {1, 2, 3}), square(), square(3),
        turned(square(), some_rotation(), {1, 2, 3})}) {
    BOOST_TEST(has(ReducedScene(scene), Reduction::mirror));
    BOOST_TEST(difference(scene, all, without(Reduction::mirror), 0.3, 1e-3) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(implicit_steps_are_the_same_too) {
  const Scene cloth = draw("cloth", {{"nodes", 7}});
  for (const char* method : {"implicit_euler", "semi_implicit_euler"}) {
    BOOST_TEST(difference(cloth, all, Reductions::only({}), 0.1, 5e-3, method) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(parts_flights_pins_and_parallel_springs_move_alike) {
  Scene scene = draw("chain", {{"nodes", 6}, {"stiffness", 1e4}});
  const Scene other = draw("pair");
  for (const Spring& spring : other.springs) {
    scene.springs.push_back({{spring.nodes[0] + 6, spring.nodes[1] + 6}, spring.law});
    scene.springs.push_back(scene.springs.back());
  }
  scene.nodes.insert(scene.nodes.end(), other.nodes.begin(), other.nodes.end());
  scene.nodes.push_back({.position = {1, 2, 3}, .velocity = {0.5, 0, 1}, .mass = 2});
  for (const Reduction reduction :
       {Reduction::pins, Reduction::duplicates, Reduction::free_flight, Reduction::parts}) {
    BOOST_TEST(has(ReducedScene(scene), reduction));
    BOOST_TEST(difference(scene, all, without(reduction), 0.5, 1e-3) < round_off);
    BOOST_TEST(difference(scene, Reductions::only({}), Reductions::only({reduction}), 0.5, 1e-3) <
               round_off);
  }
}

BOOST_AUTO_TEST_CASE(springs_in_series_move_as_with_the_massless_nodes_between_them) {
  // A heavy node swings on three springs with two massless joints, and never goes slack.
  Scene scene{.dimension = 2, .gravity = {0, -10, 0}};
  scene.nodes = {{.position = {0, 0, 0}, .pinned = true},
                 {.position = {0.2302, -0.2302, 0}},
                 {.position = {0.5946, -0.5946, 0}},
                 {.position = {0.8202, -0.8202, 0}, .velocity = {0.5, 0.5, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {300, 0.3}}, {{2, 1}, {500, 0.5}}, {{2, 3}, {400, 0.3}}};
  const ReducedScene reduced(scene);
  BOOST_TEST(reduced.system().size() == 2);
  BOOST_TEST(ReducedScene(scene, without(Reduction::massless)).system().size() == 6);
  // Implicit Euler puts massless nodes where f = 0 at the end of each step, as the series does: the
  // same steps, but for what Newton's method leaves.
  const auto condensed = end_of(scene, all, 0.4, 1e-3, "implicit_euler");
  const auto kept = end_of(scene, without(Reduction::massless), 0.4, 1e-3, "implicit_euler");
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    BOOST_TEST((condensed[i].position - kept[i].position).norm() < 1e-9);
  }
  // Velocities of joints are a difference of positions over h there, and a derivative here: they
  // differ by h |x''| / 2.
  for (const std::size_t i : {1u, 2u}) {
    BOOST_TEST((condensed[i].velocity - kept[i].velocity).norm() < 1e-3 * 20);
    BOOST_TEST((condensed[i].velocity - kept[i].velocity).norm() > 0);
  }
}

BOOST_AUTO_TEST_CASE(a_line_that_cannot_turn_moves_linearly) {
  Scene scene{.dimension = 1, .gravity = {-9.81, 0, 0}};
  for (int i = 0; i <= 10; ++i) {
    scene.nodes.push_back({.position = {0.1 * i, 0, 0},
                           .velocity = {0.05 * std::sin(3. * i), 0, 0},
                           .mass = 0.1 + 0.01 * i,
                           .pinned = i == 0 || i == 10});
  }
  for (std::size_t i = 0; i < 10; ++i) scene.springs.push_back({{i, i + 1}, {2000, 0.09}});
  const ReducedScene reduced(scene);
  BOOST_TEST(reduced.system().stiffness_is_constant());
  BOOST_TEST(difference(scene, all, without(Reduction::constant_stiffness), 1, 1e-3) < round_off);
  // An exact step of a second is compared with a thousand steps of order 8, accurate to 1e-10.
  const auto exact = end_of(scene, all, 1, 1, "exact");
  const auto composed = end_of(scene, without(Reduction::constant_stiffness), 1, 1e-4);
  BOOST_TEST(farthest(exact, composed) / farthest(exact, scene.nodes) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_growing_run_of_a_row_turns_springs_over_as_the_drawn_one_does) {
  Scene row{.dimension = 1};
  for (std::size_t i = 0; i < 9; ++i) {
    row.nodes.push_back({.position = {0.1 * static_cast<double>(i), 0, 0},
                         .velocity = {i == 4 ? 0.5 : 0, 0, 0},
                         .mass = 0.1,
                         .pinned = i == 0});
    if (i > 0) row.springs.push_back({{i - 1, i}, {1e4, 0.1}});
  }
  const Reductions drawn = Reductions().without(Reduction::constant_stiffness);
  BOOST_TEST(ReducedScene(row).parts().front().is_straightened());
  for (const char* method : {"explicit_euler", "verlet", "rk4"}) {
    const auto end = end_of(row, {}, 20 * 0.004, 0.004, method);  // h w = 2.5
    bool has_turned = false;
    for (std::size_t i = 1; i < 9; ++i) {
      has_turned = has_turned || end[i].position.x() < end[i - 1].position.x();
    }
    BOOST_TEST(has_turned == (method != std::string("rk4")));  // which is stable there
    // The same forces to the bit.
    BOOST_TEST(farthest(end, end_of(row, drawn, 20 * 0.004, 0.004, method)) == 0, method);
  }
}

BOOST_AUTO_TEST_SUITE_END()
