// Constant forces on nodes: what they do to statics, to reductions and to motions in closed form.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "qddot/scene/scene_arrays.hpp"
#include "qddot/scene/settle.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"
#include "tests/scene/scene_texts.hpp"

BOOST_AUTO_TEST_SUITE(loads)

using namespace qddot;
using Eigen::Vector3d;

namespace {

Scene loaded(Scene scene, std::size_t node, const Vector3d& load) {
  scene.nodes[node].load = load;
  return scene;
}

bool is_mirrored(const Scene& scene) { return has(Model(scene), Reduction::mirror); }
bool is_flat(const Scene& scene) { return has(Model(scene), Reduction::dimension); }

Scene cloth() { return draw("cloth", {{"nodes", 6}}); }

// A node of that mass on two springs without rest length, to pins at both sides.
Scene held(double mass) {
  Scene scene{.dimension = 2, .gravity = {0, -9.81, 0}};
  scene.nodes = {{.position = {-1, 0, 0}, .pinned = true},
                 {.position = {0.2, 0.1, 0}, .mass = mass},
                 {.position = {2, 0, 0}, .pinned = true}};
  scene.springs = {{{0, 1}, {30}}, {{1, 2}, {10}}};
  return scene;
}

// Two masses on a spring, free.
Scene dumbbell() {
  Scene scene{.dimension = 3, .gravity = {0.5, 0, -2}};
  scene.nodes = {{.position = {0, 0, 0}, .velocity = {1, 2, 0}, .mass = 1},
                 {.position = {1.2, 0, 0}, .velocity = {1, 2, 0}, .mass = 3}};
  scene.springs = {{{0, 1}, {40, 1.2}}};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(statics_have_their_closed_form) {
  // Linear springs: x = (30 p + 10 p' + F) / 40, with or without mass.
  for (const double mass : {0.0, 2.0}) {
    const Scene rest = settled(loaded(held(mass), 1, {4, 7, 0}), "test");
    const Vector3d force = Vector3d(4, 7, 0) + mass * Vector3d(0, -9.81, 0);
    const Vector3d expected = (30 * Vector3d(-1, 0, 0) + 10 * Vector3d(2, 0, 0) + force) / 40;
    BOOST_TEST((rest.nodes[1].position - expected).norm() < 20 * eps);  // some operations
  }
  // A massless joint on a line between springs with rest lengths: 50 (x - 0.5) = 20 (2.5 - x - 1)
  // + 3.
  Scene line{.dimension = 1};
  line.nodes = {
      {.pinned = true}, {.position = {1, 0, 0}}, {.position = {2.5, 0, 0}, .pinned = true}};
  line.springs = {{{0, 1}, {50, 0.5}}, {{1, 2}, {20, 1}}};
  const Scene rest = settled(loaded(line, 1, {3, 0, 0}), "test");
  BOOST_TEST(std::abs(rest.nodes[1].position.x() - (25 + 30 + 3) / 70.) < 20 * eps);
}

BOOST_AUTO_TEST_CASE(a_body_that_is_pulled_at_both_ends_rests_stretched) {
  Scene pulled = dumbbell();
  pulled.gravity.setZero();
  for (Node& node : pulled.nodes) node.velocity.setZero();
  pulled.nodes[0].load = {-6, 0, 0};
  pulled.nodes[1].load = {6, 0, 0};
  const Scene rest = settled(pulled, "test");
  const double length = (rest.nodes[1].position - rest.nodes[0].position).norm();
  BOOST_TEST(std::abs(length - (1.2 + 6. / 40)) < 20 * eps);
  // It falls for ever where the loads do not balance.
  pulled.nodes[1].load = {7, 0, 0};
  BOOST_TEST(names_all(refusal_of([&] { settled(pulled, "test"); }), {"test", "falls for ever"}));
}

BOOST_AUTO_TEST_CASE(a_load_breaks_the_mirror_that_it_is_not_mirrored_by) {
  BOOST_TEST(is_mirrored(cloth()));
  // Nodes 8 and 26 are images of each other.
  const Scene one = loaded(cloth(), 8, {0, 0, 1e-9});
  BOOST_TEST(!is_mirrored(one));
  BOOST_TEST(is_mirrored(loaded(one, 26, {0, 0, 1e-9})));
  const Scene across = loaded(cloth(), 8, {1, 2, 3});
  BOOST_TEST(!is_mirrored(loaded(across, 26, {1, 2, 3})));
  BOOST_TEST(is_mirrored(loaded(across, 26, {-1, 2, 3})));
  BOOST_TEST(!is_mirrored(loaded(across, 26, {-1, 2, 3 + 1e-9})));
  // The same wherever it lies.
  BOOST_TEST(
      is_mirrored(turned(loaded(across, 26, {-1, 2, 3}), some_rotation(), Vector3d(1, -2, 3))));
  // A pin carries its load, which then breaks nothing.
  Scene pinned = cloth();
  for (Node& node : pinned.nodes) node.load = node.pinned ? node.position : Vector3d(0, 0, 0);
  BOOST_TEST(is_mirrored(pinned));
}

BOOST_AUTO_TEST_CASE(a_load_out_of_the_plane_leaves_it) {
  const Scene chain = draw("chain", {{"nodes", 6}});
  BOOST_TEST(is_flat(loaded(chain, 3, {1, 0, 2})));
  BOOST_TEST(!is_flat(loaded(chain, 3, {0, 1e-300, 0})));
  // Bent, or any load would be in a plane with it.
  Scene bent = chain;
  bent.nodes[2].position.z() = -0.1;
  const Scene tilted = turned(loaded(bent, 3, {1, 0, 2}), some_rotation(), {1, 2, 3});
  BOOST_TEST(is_flat(tilted));
  Scene off = tilted;
  off.nodes[3].load += 1e-10 * (some_rotation() * Vector3d::UnitY());
  BOOST_TEST(!is_flat(off));
  BOOST_TEST(contains(sentence(Model(tilted), Reduction::dimension), {"gravity and loads"}));
}

BOOST_AUTO_TEST_CASE(a_massless_joint_with_a_load_stays) {
  Scene scene = held(0);
  BOOST_TEST(Model(scene).system().size() == 0);
  BOOST_TEST(Model(loaded(scene, 1, {0, 1, 0})).system().size() == 2);
}

BOOST_AUTO_TEST_CASE(what_loads_pull_apart_does_not_rest_in_its_fall) {
  BOOST_TEST(Model(dumbbell()).system().size() == 0);
  const Model along(loaded(dumbbell(), 0, {0.5, 0, 0})),
      across(loaded(dumbbell(), 0, {0.5, 0.1, 0}));
  BOOST_TEST(along.system().size() == 2);
  BOOST_TEST(across.system().size() == 4);
  BOOST_TEST(contains(sentence(along, Reduction::falling), {"all loads together are left out"}));
}

BOOST_AUTO_TEST_CASE(springs_count_as_straight_only_where_loads_turn_none) {
  Scene free{.dimension = 1};
  for (const double x : {0.0, 1.0}) free.nodes.push_back({.position = {x, 0, 0}, .mass = 1});
  free.springs = {{{0, 1}, {10, 1}}};
  const auto is_straight = [](const Scene& scene) {
    return Model(scene, Reductions().without(Reduction::falling).without(Reduction::mirror))
        .parts()
        .front()
        .is_straightened();
  };
  BOOST_TEST(is_straight(free));
  free.nodes[0].load.x() = 100;  // pushes the two through each other
  free.nodes[1].load.x() = -100;
  BOOST_TEST(!is_straight(free));
  // At a pin the equilibrium decides: 10 N/m at 1 m bear up to 10/4 N from rest.
  Scene pinned = free;
  pinned.nodes[0].pinned = true;
  pinned.nodes[1].load.x() = -2;
  BOOST_TEST(is_straight(pinned));
  pinned.nodes[1].load.x() = -6;
  BOOST_TEST(!is_straight(pinned));
}

BOOST_AUTO_TEST_CASE(a_node_on_no_spring_flies_with_its_load) {
  Scene scene{.dimension = 3, .gravity = {0, 0, -9.81}};
  scene.nodes = {{.position = {1, 2, 3}, .velocity = {1, 0, 2}, .mass = 2, .load = {3, -1, 0.5}}};
  const Model reduced(scene);
  BOOST_TEST(reduced.system().size() == 0);
  const double t = 1.5;
  const State later{t, Vec(0), Vec(0)};
  const Vector3d a = scene.gravity + scene.nodes[0].load / 2;
  const Node node = reduced.expand(later).front();
  BOOST_TEST((node.position - (Vector3d(1, 2, 3) + t * Vector3d(1, 0, 2) + t * t / 2 * a)).norm() <
             40 * eps);
  BOOST_TEST((node.velocity - (Vector3d(1, 0, 2) + t * a)).norm() < 40 * eps);
  const double v = potential_by_hand(scene, reduced.expand(later));
  BOOST_TEST(std::abs(reduced.potential(later) - v) < 40 * eps * std::abs(v));
  BOOST_TEST(reduced.energy(later) == reduced.energy(reduced.initial()));
}

BOOST_AUTO_TEST_CASE(loads_are_read_written_hashed_and_told_of) {
  const Scene plain = parsed(two_links),
              scene = parsed(with(two_links, "mass = 2\n", "mass = 2\nload = [0.5, -1]\n"));
  BOOST_TEST((scene.nodes[1].load == Vector3d(0.5, -1, 0)));
  BOOST_TEST(scene.warnings.empty());
  BOOST_TEST(content_hash(scene) != content_hash(plain));
  BOOST_TEST(content_hash(loaded(scene, 1, {0, 0, 0})) == content_hash(plain));
  BOOST_TEST(content_hash(loaded(plain, 0, {1, 0, 0})) == content_hash(plain));  // pinned
  const Scene carried = parsed(with(two_links, "mass = 0.1\n", "mass = 0.1\nload = [1, 0]\n"));
  BOOST_TEST_REQUIRE(carried.warnings.size() == 1u);
  BOOST_TEST(contains(carried.warnings[0], {"1 pinned node", "carried by its pin"}));
}

BOOST_AUTO_TEST_CASE(loads_that_nothing_resists_are_refused) {
  const std::string load = "load = [0, 3]\n";
  BOOST_TEST(names_all(refusal(with(two_links, "mass = 2\n", "mass = 2\nload = [0, inf]\n")),
                       {"a.toml", "nodes[1].load", "inf", "2 finite numbers"}));
  // A massless node on a spring is held, but not by one without stiffness.
  const std::string massless = with(two_links, "mass = 2\n", "mass = 0\n" + load);
  BOOST_TEST(refusal(massless) == "");
  BOOST_TEST(names_all(
      refusal(with(with(massless, "1000.0", "0"), "quartic = 7.0", "quartic = 0")),
      {"nodes[1].load", "[0, 3, 0]", "neither mass nor a spring that pulls", "allowed is zero"}));
}

BOOST_AUTO_TEST_CASE(generators_take_loads_of_chosen_nodes) {
  const std::string chain = "[generator]\nkind = 'chain'\nnodes = 5\n[[generator.load]]\n";
  const Scene by_nodes = parsed(chain + "nodes = [2, 4, 2]\nforce = [0, 1, 2]\n");
  for (std::size_t i = 0; i < 5; ++i)
    BOOST_TEST(
        (by_nodes.nodes[i].load == (i == 2 || i == 4 ? Vector3d(0, 1, 2) : Vector3d(0, 0, 0))));
  // The total is shared, and loads add up.
  const std::string box = "min = [-9, -9, -9]\nmax = [9, 9, 9]\n";
  const Scene by_box = parsed(chain + box + "total_force = [0, 0, 10]\n[[generator.load]]\n" + box +
                              "force = [1, 0, 0]\n");
  for (const Node& node : by_box.nodes) BOOST_TEST((node.load == Vector3d(1, 0, 2)));
  BOOST_TEST(names_all(refusal(chain + "nodes = [5]\nforce = [0, 1, 2]\n"),
                       {"generator.load[0].nodes", "5 is not a node"}));
  BOOST_TEST(names_all(refusal(chain + "nodes = [4]\n"),
                       {"generator.load[0].force", "exactly one of force", "total_force"}));
  BOOST_TEST(names_all(refusal(chain + "nodes = [4]\ngroup = 3\nforce = [0, 1, 2]\n"),
                       {"generator.load[0].nodes", "one of nodes, group, and a box"}));
  BOOST_TEST(names_all(refusal(chain + "group = 3\nforce = [0, 1, 2]\n"),
                       {"generator.load[0].group", "3", "this one has none"}));
  BOOST_TEST(names_all(refusal(chain + "nodes = [4]\ndimension = 2\nforce = [0, 1, 2]\n"),
                       {"generator.load[0].dimension", "beside group alone"}));
}

BOOST_AUTO_TEST_CASE(arrays_give_loads) {
  SceneArrays a;
  a.positions = Eigen::MatrixXd{{0, 0}, {1, 0}};
  a.mass = Eigen::VectorXd::Ones(1);
  a.stiffness = Eigen::VectorXd::Ones(1);
  a.springs = {{0, 1}};
  a.load = Eigen::MatrixXd{{0, 0}, {3, -4}};
  BOOST_TEST((scene_of(a).nodes[1].load == Vector3d(3, -4, 0)));
  a.load = Eigen::MatrixXd::Zero(1, 2);
  BOOST_TEST(names_all(refusal_of([&] { scene_of(a); }), {"load: 2 entries; allowed are 4"}));
}

BOOST_AUTO_TEST_SUITE_END()
