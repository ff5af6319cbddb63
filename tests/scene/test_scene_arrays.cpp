// Scenes from arrays, against the same scenes from files.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/scene_arrays.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(scene_arrays)

using namespace qddot;

namespace {

// The arrays of a scene.
SceneArrays arrays_of(const Scene& scene) {
  SceneArrays a;
  const auto n = std::ssize(scene.nodes), m = std::ssize(scene.springs);
  a.positions.resize(n, scene.dimension);
  a.velocities.resize(n, scene.dimension);
  a.mass.resize(n);
  a.gravity = scene.gravity.head(scene.dimension);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Node& node = scene.nodes[static_cast<std::size_t>(i)];
    a.positions.row(i) = node.position.head(scene.dimension).transpose();
    a.velocities.row(i) = node.velocity.head(scene.dimension).transpose();
    a.mass[i] = node.mass;
    if (node.pinned) a.pinned.push_back(static_cast<std::size_t>(i));
  }
  a.stiffness.resize(m);
  a.rest_length.resize(m);
  a.quartic.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Spring& spring = scene.springs[static_cast<std::size_t>(i)];
    a.springs.push_back(spring.nodes);
    a.stiffness[i] = spring.law.stiffness;
    a.rest_length[i] = spring.law.rest_length;
    a.quartic[i] = spring.law.quartic;
  }
  return a;
}

SceneArrays two_links() {
  SceneArrays a;
  a.positions = Eigen::MatrixXd{{0, 0}, {0.5, 0}, {1, 0}};
  a.springs = {{0, 1}, {1, 2}};
  a.mass = Eigen::VectorXd::Constant(1, 0.1);
  a.stiffness = Eigen::VectorXd::Constant(1, 1000);
  a.pinned = {0};
  a.gravity = Eigen::Vector2d(0, -9.81);
  return a;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_comes_back_from_its_arrays) {
  for (const char* name : {"oscillator", "pair", "cloth", "lattice", "fpu", "strut"}) {
    Scene scene = load_scene(name);
    scene.until.reset();
    scene.starts_at_equilibrium = false;
    scene.stiff_above.reset();
    BOOST_TEST(content_hash(scene_of(arrays_of(scene))) == content_hash(scene), name);
  }
}

BOOST_AUTO_TEST_CASE(one_value_serves_all_and_springs_are_as_long_as_given) {
  const Scene scene = scene_of(two_links());
  BOOST_TEST(scene.dimension == 2);
  BOOST_TEST(scene.nodes[0].pinned);
  BOOST_TEST(!scene.nodes[2].pinned);
  for (const Node& node : scene.nodes) BOOST_TEST(node.mass == 0.1);
  for (const Spring& spring : scene.springs) {
    BOOST_TEST(spring.law.stiffness == 1000);
    BOOST_TEST(spring.law.rest_length == 0.5);
  }
}

BOOST_AUTO_TEST_CASE(arrays_that_do_not_fit_are_refused_by_name) {
  const auto refusal = [](const auto& change) {
    SceneArrays a = two_links();
    change(a);
    return refusal_of([&] { scene_of(a); });
  };
  using A = SceneArrays;
  BOOST_TEST(refusal([](A&) {}) == "");
  for (const auto& [said, words] : std::vector<std::array<std::string, 2>>{
           {refusal([](A& a) { a.mass = Eigen::VectorXd::Ones(2); }),
            "mass: 2 entries; allowed are 1 or 3"},
           {refusal([](A& a) { a.springs[1][1] = 3; }),
            "springs[1]: node 3 is none of the 3 nodes"},
           {refusal([](A& a) { a.pinned = {7}; }), "pinned[0]: node 7"},
           {refusal([](A& a) { a.gravity = Eigen::Vector3d(0, -9.81, 0); }),
            "gravity: 3 entries; allowed are 2"},
           {refusal([](A& a) { a.positions.resize(3, 4); }), "positions: 4 columns"},
           {refusal([](A& a) { a.velocities = Eigen::MatrixXd::Zero(3, 1); }),
            "velocities: 3 entries"},
           {refusal([](A& a) { a.stiffness[0] = -1; }), "stiffness"},
           {refusal([](A& a) { a.springs[0][0] = 1; }), "springs[0]"}})
    BOOST_TEST(names_all(said, {words}), said);
}

BOOST_AUTO_TEST_SUITE_END()
