// Massless joints on a line that are drawn beyond the ends of their springs. The tests check which
// of their places of rest they go to, and that the reduced scene has the same.
#include <boost/test/unit_test.hpp>

#include "tests/integrators/scenes.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(folded_joints)

using namespace qddot;

namespace {

// A pin at 0, a joint, and 1 kg at 2 m; on the axis of x of a scene of any dimension.
Scene folded(double joint, double k, double l0, int dimension = 1) {
  Scene scene{.dimension = dimension};
  scene.nodes = {{.pinned = true}, {.position = {joint, 0, 0}}, {.position = {2, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {k, l0}}, {{1, 2}, {10, 0}}};
  return scene;
}

bool is_kept(const Scene& scene) { return !Model(scene).massless_nodes().empty(); }

// The place of the mass at 0.1 s by steps of implicit Euler, which puts joints where f = 0.
double end_of(const Scene& scene) {
  const auto nodes = nodes_after(scene, {}, method_named("implicit_euler"), 1e-4, 0.1);
  return nodes.back().position.x();
}

// The place at which the joint rests if it follows its force from its drawn place, with resting
// ends.
double rest_below(const Scene& scene) {
  double x = scene.nodes[1].position.x();
  for (int step = 0; step < 100000; ++step) {
    double f = 0;
    for (const Spring& spring : scene.springs) {
      const auto [a, b] = spring.nodes;
      const double end = scene.nodes[a == 1 ? b : a].position.x();
      f += spring.law.tension(std::abs(end - x)) * (end < x ? -1 : 1);
    }
    x += 1e-5 * f;  // far below 2/k, and short beside all lengths
  }
  return x;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_joint_behind_the_pin_stays_there) {
  const Scene scene = folded(-0.4, 1000, 0.5);
  BOOST_TEST(is_kept(scene));
  // Both springs are one of 1000 10 / 1010 N/m that pulls towards -0.5 m:
  const double k = 1000. * 10 / 1010, w = std::sqrt(k);
  const double exact = -0.5 + 2.5 * std::cos(w * 0.1);
  BOOST_TEST(std::abs(exact - 1.877) < 1e-3);
  // Implicit Euler is of first order: h w^2 t / 2 of the amplitude.
  BOOST_TEST(std::abs(end_of(scene) - exact) < 1e-4 * k * 0.1 * 2.5);
  // The straight one pulls towards 0.5 m.
  BOOST_TEST(!is_kept(folded(0.4, 1000, 0.5)));
  BOOST_TEST(std::abs(end_of(folded(0.4, 1000, 0.5)) - 0.5 - 1.5 * std::cos(w * 0.1)) <
             1e-4 * k * 0.1 * 2.5);
}

BOOST_AUTO_TEST_CASE(a_joint_is_kept_if_it_comes_down_to_rest_beyond_an_end) {
  for (const double joint : {-3., -0.4, -0.01, 0.3, 1.9, 2.01, 2.4, 5.}) {
    for (const double k : {5., 30., 1000.}) {
      for (const bool is_turned : {false, true}) {
        Scene scene = folded(joint, k, 0.5);
        if (is_turned) scene.springs = {{{0, 1}, {10, 0.3}}, {{2, 1}, {k, 0.5}}};
        const double rest = rest_below(scene);
        const bool is_between = rest > 0 && rest < 2;
        BOOST_TEST(is_kept(scene) == !is_between, joint << " " << k << " " << is_turned);
        if (!is_between) continue;
        const double series = k * 10 / (k + 10), l0 = is_turned ? 0.8 : 0.5;
        const double exact = l0 + (2 - l0) * std::cos(std::sqrt(series) * 0.1);
        // h w^2 t / 2 of the amplitude.
        BOOST_TEST(std::abs(end_of(scene) - exact) < 1e-4 * series * 0.1 * 2);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_joint_that_is_pulled_over_its_end_is_straight) {
  // Folded, the tension is k 10 / (k + 10) 2.5 N, against k 0.5 N: more where k < 40.
  BOOST_TEST(is_kept(folded(-0.4, 40.01, 0.5)));
  BOOST_TEST(!is_kept(folded(-0.4, 39.99, 0.5)));
}

BOOST_AUTO_TEST_CASE(only_what_stays_on_a_line_can_stay_folded) {
  for (const int dimension : {2, 3}) {
    const Scene on_line = folded(-0.4, 1000, 0.5, dimension);
    BOOST_TEST(is_kept(on_line));
    Scene swings = on_line;
    swings.nodes[2].velocity.y() = 1e-3;
    BOOST_TEST(!is_kept(swings));
    Scene beside = on_line;
    beside.nodes[1].position.y() = 1e-12;
    BOOST_TEST(!is_kept(beside));
    Scene oblique = turned(on_line, some_rotation(), {0, 0, 0});
    BOOST_TEST(is_kept(oblique));
  }
}

BOOST_AUTO_TEST_CASE(of_several_joints_the_order_counts) {
  Scene scene{.dimension = 1};
  scene.nodes = {{.pinned = true},
                 {.position = {0.5, 0, 0}},
                 {.position = {1, 0, 0}},
                 {.position = {2, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {100, 0.3}}, {{2, 1}, {100, 0.3}}, {{2, 3}, {100, 0.3}}};
  BOOST_TEST(!is_kept(scene));
  std::swap(scene.nodes[1].position, scene.nodes[2].position);
  BOOST_TEST(is_kept(scene));
  // A spring without rest length has no direction to keep.
  scene.springs[1].law.rest_length = 0;
  BOOST_TEST(!is_kept(scene));
}

BOOST_AUTO_TEST_SUITE_END()
