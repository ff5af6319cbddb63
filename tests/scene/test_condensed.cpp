// Series of springs, straight lines, free flight: the parts of a scene that have a closed form.
#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(condensed)

using namespace qddot;

namespace {

// A massless node between a pin and a mass, in space; drawn where it does not rest.
Scene two_in_series(double length) {
  Scene scene;
  scene.nodes = {{.position = {0, 0, 0}, .pinned = true},
                 {.position = {0.1, 0.2, 0.3}},
                 {.position = {length, 0, 0}, .velocity = {0.3, 0.7, 0}, .mass = 2}};
  scene.springs = {{{0, 1}, {30, 0.5}}, {{2, 1}, {60, 0.4}}};
  return scene;
}

// Masses in a row on a line, k = 100 N/m and l0 = 1 m, let go with a common speed.
Scene row(double speed, bool is_pinned) {
  Scene scene{.dimension = 1};
  for (int i = 0; i < 4; ++i) {
    scene.nodes.push_back({.position = {1.0 * i, 0, 0},
                           .velocity = {i == 1 ? speed : 0, 0, 0},
                           .mass = 1,
                           .pinned = is_pinned && (i == 0 || i == 3)});
  }
  for (std::size_t i = 0; i < 3; ++i) scene.springs.push_back({{i, i + 1}, {100, 1}});
  return scene;
}
bool is_straight(const Scene& scene) { return Model(scene).system().stiffness_is_constant(); }

}  // namespace

BOOST_AUTO_TEST_CASE(series_have_the_sum_of_compliances_and_rest_lengths) {
  const Model reduced(two_in_series(1.2));
  BOOST_TEST(reduced.massless_nodes().empty());
  // 20 N/m and 0.9 m: f = -20 (1.2 - 0.9).
  BOOST_TEST(force_at(reduced.system(), reduced.initial().q)[0] == -6,
             boost::test_tools::tolerance(10 * eps));
  const auto nodes = reduced.expand(reduced.initial());
  // The joint is where 30 (x - 0.5) = 60 (1.2 - x - 0.4) = 6, and moves with it.
  BOOST_TEST((nodes[1].position - Eigen::Vector3d(0.7, 0, 0)).norm() < 10 * eps);
  BOOST_TEST((nodes[1].velocity - Eigen::Vector3d(0.2, 0.7 * 0.7 / 1.2, 0)).norm() < 10 * eps);
}

BOOST_AUTO_TEST_CASE(series_hold_in_tension_only) {
  BOOST_TEST(Model(two_in_series(0.9 * (1 + 1e-9))).massless_nodes().empty());
  BOOST_TEST(Model(two_in_series(0.9)).massless_nodes().empty());
  // They fold up in compression: the node stays, and is named.
  const Model compressed(two_in_series(0.9 * (1 - 1e-9)));
  BOOST_TEST((compressed.massless_nodes() == std::vector<std::size_t>{1}));

  const Model reduced(two_in_series(1.2));
  Vec q = reduced.initial().q;
  q.setZero();
  q[0] = 0.9 * (1 + 1e-9);
  BOOST_TEST(is_valid_at(reduced.system(), q));
  q[0] = 0.9 * (1 - 1e-9);
  BOOST_TEST(!is_valid_at(reduced.system(), q));
}

BOOST_AUTO_TEST_CASE(what_is_no_series_is_left) {
  const auto is_left = [](const auto& change) {
    Scene scene = two_in_series(1.2);
    change(scene);
    return !Model(scene).massless_nodes().empty();
  };
  BOOST_TEST(!is_left([](Scene&) {}));
  BOOST_TEST(is_left([](Scene& s) { s.springs[0].law.quartic = 1; }));
  BOOST_TEST(is_left([](Scene& s) { s.springs.pop_back(); }));
  BOOST_TEST(is_left([](Scene& s) {  // a third spring at the joint
    s.nodes.push_back({.position = {0, 1, 0}, .pinned = true});
    s.springs.push_back({{1, 3}, {10, 0.1}});
  }));
  BOOST_TEST(is_left([](Scene& s) {  // both springs to the same node
    s.springs[0].nodes = {1, 2};
    s.springs[0].law.rest_length = 0.3;
  }));
  BOOST_TEST(is_left([](Scene& s) {  // a ring of massless nodes
    s.nodes[2].mass = 0;
    s.springs = {{{1, 2}, {10, 0.1}}, {{2, 3}, {10, 0.1}}, {{3, 1}, {10, 0.1}}};
    s.nodes.push_back({.position = {0, 1, 0}});
  }));
  // Two parallel ones count as one.
  BOOST_TEST(!is_left([](Scene& s) { s.springs.push_back(s.springs[0]); }));
}

BOOST_AUTO_TEST_CASE(long_series_are_one_spring) {
  Scene scene{.dimension = 2, .gravity = {0, -10, 0}};
  for (int i = 0; i <= 20; ++i) {
    scene.nodes.push_back(
        {.position = {0, -0.1 * i, 0}, .mass = i == 20 ? 1.0 : 0.0, .pinned = i == 0});
  }
  // Springs listed backwards and turned round.
  for (std::size_t i = 20; i > 0; --i) {
    scene.springs.push_back({{i, i - 1}, {100. + static_cast<double>(i), 0.1}});
  }
  const Model reduced(scene);
  BOOST_TEST(reduced.system().size() == 1);
  double compliance = 0;
  for (int i = 1; i <= 20; ++i) compliance += 1 / (100. + i);
  const double k = dense(stiffness_at(reduced.system(), reduced.initial().q))(0, 0);
  BOOST_TEST(-k == 1 / compliance, boost::test_tools::tolerance(100 * eps));
  // Each joint's springs pull alike.
  State state = reduced.initial();
  state.q[0] -= 0.5;
  const auto nodes = reduced.expand(state);
  const double tension = 0.5 / compliance;
  for (std::size_t i = 1; i <= 20; ++i) {
    const double length = (nodes[i].position - nodes[i - 1].position).norm();
    BOOST_TEST((100. + static_cast<double>(i)) * (length - 0.1) == tension,
               boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(a_line_is_straight_up_to_the_energy_that_turns_a_spring) {
  // Free: about the centre of mass T = 1/2 v^2 (1 - 1/4), against 1/2 k l0^2 = 50 J.
  const double free = std::sqrt(50 / 0.375);
  BOOST_TEST(is_straight(row(free * (1 - 1e-5), false)));
  BOOST_TEST(!is_straight(row(free * (1 + 1e-5), false)));
  // Pinned: at rest where it is drawn, so that 1/2 v^2 stands against the same.
  BOOST_TEST(is_straight(row(10 * (1 - 1e-5), true)));
  BOOST_TEST(!is_straight(row(10 * (1 + 1e-5), true)));
}

BOOST_AUTO_TEST_CASE(gravity_may_turn_a_spring) {
  // A mass above its support: it sinks by m g / k, and overshoots to twice that.
  const auto standing = [](double g) {
    Scene scene{.dimension = 1, .gravity = {-g, 0, 0}};
    scene.nodes = {{.pinned = true}, {.position = {1, 0, 0}, .mass = 1}};
    scene.springs = {{{0, 1}, {100, 1}}};
    return scene;
  };
  BOOST_TEST(is_straight(standing(49.9)));
  BOOST_TEST(!is_straight(standing(50.1)));
  BOOST_TEST(!is_straight(standing(101)));  // there is no rest above the support at all
}

BOOST_AUTO_TEST_CASE(only_linear_laws_on_a_line_are_straightened) {
  Scene scene = row(1, true);
  BOOST_TEST(is_straight(scene));
  scene.springs[1].law.quartic = 1;
  BOOST_TEST(!is_straight(scene));
  Scene plane = row(1, true);
  plane.dimension = 2;
  plane.nodes[1].velocity.y() = 1e-3;
  BOOST_TEST(!is_straight(plane));
  BOOST_TEST(!Model(row(1, true), Reductions().without(Reduction::constant_stiffness))
                  .system()
                  .stiffness_is_constant());
}

BOOST_AUTO_TEST_CASE(nodes_on_no_spring_fly_in_closed_form) {
  Scene scene{.gravity = {0, 0, -8}};
  scene.nodes = {{.position = {1, 2, 3}, .velocity = {4, 5, 6}, .mass = 2},
                 {.position = {0, 0, 1}, .velocity = {1, 0, 0}},  // no weight without mass
                 {.position = {7, 7, 7}, .velocity = {1, 1, 1}, .pinned = true}};
  const Model reduced(scene);
  BOOST_TEST(reduced.system().size() == 0);
  const State later{0.5, Vec(), Vec()};
  const auto nodes = reduced.expand(later);
  BOOST_TEST((nodes[0].position == Eigen::Vector3d(3, 4.5, 5)));
  BOOST_TEST((nodes[0].velocity == Eigen::Vector3d(4, 5, 2)));
  BOOST_TEST((nodes[1].position == Eigen::Vector3d(0.5, 0, 1)));
  BOOST_TEST((nodes[2].position == Eigen::Vector3d(7, 7, 7)));
  BOOST_TEST((nodes[2].velocity == Eigen::Vector3d::Zero()));
  BOOST_TEST(reduced.energy(later) == reduced.energy(reduced.initial()),
             boost::test_tools::tolerance(10 * eps));
  BOOST_TEST(reduced.potential(later) == 16. * 5);
}

// Pinned, condensed, flying and falling nodes, and one with unknowns of its own.
BOOST_AUTO_TEST_CASE(a_scene_is_expanded_to_the_same_in_memory_that_holds_another_state) {
  Scene scene = two_in_series(1.2);
  scene.gravity = {0, 0, -8};
  scene.nodes.push_back({.position = {1, 2, 3}, .velocity = {4, 5, 6}, .mass = 2});
  for (const double x : {5, 6})
    scene.nodes.push_back({.position = {x, 5, 5}, .velocity = {0, x, 0}, .mass = 1});
  scene.springs.push_back({{4, 5}, {100, 0.8}});
  const Model reduced(scene);
  BOOST_REQUIRE(reduced.findings().size() >= 4);
  const State& start = reduced.initial();
  const State later{0.5, start.q + 0.01 * start.v, 2 * start.v};
  std::vector<Node> nodes;
  for (const State& state : {later, start, later}) {
    reduced.expand(state, nodes);
    const std::vector<Node> fresh = reduced.expand(state);
    BOOST_REQUIRE(nodes.size() == fresh.size());
    BOOST_TEST(farthest(nodes, fresh) == 0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      BOOST_TEST(nodes[i].mass == fresh[i].mass);
      BOOST_TEST(nodes[i].pinned == fresh[i].pinned);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
