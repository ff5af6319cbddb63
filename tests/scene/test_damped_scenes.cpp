// Dashpots and air in scenes: how they are read, written, refused and reduced.
#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/reduce/flight.hpp"
#include "qddot/scene/scene_arrays.hpp"
#include "tests/scene/refusal.hpp"
#include "tests/scene/same_scene.hpp"
#include "tests/scene/scene_texts.hpp"

BOOST_AUTO_TEST_SUITE(damped_scenes)

using namespace qddot;

namespace {

const std::string three_nodes =
    "dimension = 2\nair_damping = 0.25\ndamping_time = 1e-3\n"
    "nodes = [{position = [0, 0], pinned = true}, {position = [1, 0], mass = 1},"
    " {position = [2, 0.5], mass = 2}]\n";

std::size_t found(const Model& model, Reduction reduction) {
  return static_cast<std::size_t>(
      std::ranges::count(model.findings(), reduction, &Finding::reduction));
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_springs_own_damping_goes_before_the_damping_time) {
  const Scene scene = parsed(three_nodes +
                             "springs = [{nodes = [0, 1], stiffness = 100},"
                             " {nodes = [1, 2], stiffness = 200, damping = 0.7}]\n");
  BOOST_TEST(scene.air_damping == 0.25);
  BOOST_TEST(scene.springs[0].law.damping == 1e-3 * 100);
  BOOST_TEST(scene.springs[1].law.damping == 0.7);
  BOOST_TEST(is_damped(scene));
  const Scene written = parsed(to_toml(scene));
  BOOST_TEST(first_difference(written, scene) == "");
  BOOST_TEST(content_hash(written) == content_hash(scene));
}

BOOST_AUTO_TEST_CASE(meshes_and_generators_take_damping) {
  const Scene generated = parsed(
      "[generator]\nkind = \"chain\"\nnodes = 4\nstiffness = 50\ndamping_time = 0.01\n"
      "air_damping = 2\n");
  BOOST_TEST(generated.air_damping == 2);
  for (const Spring& spring : generated.springs) BOOST_TEST(spring.law.damping == 0.5);
  const Scene beside = parsed("air_damping = 3\n[generator]\nkind = \"chain\"\nnodes = 4\n");
  BOOST_TEST(beside.air_damping == 3);
  for (const Generator& generator : generators()) {
    const Scene scene = generate(generator, {{"damping_time", 1e-3}, {"air_damping", 0.1}}, "a");
    BOOST_TEST(scene.air_damping == 0.1);
    for (const Spring& spring : scene.springs)
      BOOST_TEST(spring.law.damping == 1e-3 * spring.law.stiffness);
    BOOST_TEST(!is_damped(generate(generator, {}, "a")));
  }
}

BOOST_AUTO_TEST_CASE(undamped_scenes_have_the_hash_that_they_had) {
  Scene scene = parsed(two_links);
  const std::string before = content_hash(scene);
  scene.springs[0].law.damping = 1;
  BOOST_TEST(content_hash(scene) != before);
  scene.springs[0].law.damping = 0;
  scene.air_damping = 1;
  BOOST_TEST(content_hash(scene) != before);
  scene.air_damping = 0;
  BOOST_TEST(content_hash(scene) == before);
}

BOOST_AUTO_TEST_CASE(negative_damping_is_refused_by_name) {
  const std::string spring = "springs = [{nodes = [0, 1], stiffness = 1, damping = -1}]\n";
  BOOST_TEST(refusal(three_nodes + spring).find("damping: -1 is not allowed") != std::string::npos);
  for (const char* key : {"air_damping", "damping_time"}) {
    const std::string text = std::string(key) + " = -2\n" + two_links;
    BOOST_TEST(refusal(text).find(key) != std::string::npos);
  }
  SceneArrays arrays;
  arrays.positions = Eigen::MatrixXd{{0., 0.}, {1., 0.}};
  arrays.springs = {{0, 1}};
  arrays.mass = arrays.stiffness = Vec::Ones(1);
  arrays.damping = Vec::Constant(1, -3);
  BOOST_TEST(refusal_of([&] { scene_of(arrays); }).find("springs[0].damping: -3") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(springs_between_the_same_nodes_add_their_dashpots) {
  const Model model(parsed(three_nodes +
                           "springs = [{nodes = [0, 1], stiffness = 100, damping = 0.3},"
                           " {nodes = [1, 0], stiffness = 0, damping = 0.4},"
                           " {nodes = [1, 2], stiffness = 0, damping = 0.5}]\n"));
  BOOST_TEST(found(model, Reduction::duplicates) == 1);
  const State& start = model.initial();
  // Node 1 moves along the merged dashpot, whose air takes 0.25 kg/s.
  Vec v = Vec::Zero(4), f(4);
  v[0] = 2;
  model.system().damping()->friction({0, start.q, v}, f);
  const double cosine2 = 1 / 1.25;  // of the third dashpot, which lies at an angle
  BOOST_TEST(std::abs(f[0] + 2 * (0.7 + 0.25 + 0.5 * cosine2)) < 1e-14);
}

// A mirror image has the same dashpots, or there is no mirror.
BOOST_AUTO_TEST_CASE(a_mirror_is_found_only_where_dashpots_are_alike) {
  const auto model = [](double left, double right) {
    Scene scene = parsed(
        "dimension = 2\ngravity = [0, -9.81]\n"
        "nodes = [{position = [-1, 0], pinned = true}, {position = [1, 0], pinned = true},"
        " {position = [-0.3, -0.2], mass = 1}, {position = [0.3, -0.2], mass = 1}]\n"
        "springs = [{nodes = [0, 2], stiffness = 100}, {nodes = [1, 3], stiffness = 100},"
        " {nodes = [2, 3], stiffness = 80}]\n");
    scene.springs[0].law.damping = left;
    scene.springs[1].law.damping = right;
    return Model(scene);
  };
  BOOST_TEST(found(model(0.5, 0.5), Reduction::mirror) == 1);
  BOOST_TEST(found(model(0.5, 0.6), Reduction::mirror) == 0);
}

// A massless node on two springs is left out as long as no dashpot holds it.
BOOST_AUTO_TEST_CASE(springs_in_series_are_one_without_dashpots_alone) {
  const auto model = [](double damping) {
    Scene scene = parsed(
        "dimension = 2\ngravity = [0, -9.81]\n"
        "nodes = [{position = [0, 0], pinned = true}, {position = [0, -1.1], mass = 0},"
        " {position = [0.1, -2.4], mass = 1}]\n"
        "springs = [{nodes = [0, 1], stiffness = 100, rest_length = 1},"
        " {nodes = [1, 2], stiffness = 100, rest_length = 1}]\n");
    scene.springs[0].law.damping = damping;
    return Model(scene);
  };
  BOOST_TEST(found(model(0), Reduction::massless) == 1);
  BOOST_TEST(found(model(0.1), Reduction::massless) == 0);
}

// x'' = g - alpha x' of a node on no spring, and of the centre of mass of a part without pins.
BOOST_AUTO_TEST_CASE(what_falls_in_air_tends_to_its_terminal_speed) {
  const Model model(
      parsed("dimension = 2\ngravity = [0, -9.81]\nair_damping = 0.5\ndamping_time = 0.01\n"
             "nodes = [{position = [5, 0], mass = 3, velocity = [2, 1]},"
             " {position = [0, 0], mass = 1, velocity = [0, 4]},"
             " {position = [1, 0], mass = 2, velocity = [1, 1]}]\n"
             "springs = [{nodes = [1, 2], stiffness = 10, rest_length = 0.9}]\n"));
  BOOST_TEST(found(model, Reduction::free_flight) == 1);
  BOOST_TEST(found(model, Reduction::falling) == 1);
  State late = model.initial();
  late.t = 60;
  late.v.setZero();
  for (const Node& node : model.expand(late))
    BOOST_TEST((node.velocity - Eigen::Vector3d(0, -9.81 / 0.5, 0)).norm() < 1e-11);

  // Against a sum of short steps of the midpoint rule: errors of 1e-8 of the motion.
  Eigen::Vector2d x(5, 0), v(2, 1);
  constexpr int steps = 20'000;
  const double until = 1.7, h = until / steps;
  double taken = 0;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2d g(0, -9.81), middle = (v + h / 2 * g) / (1 + h / 2 * 0.5);
    x += h * middle;
    v += h * (g - 0.5 * middle);
    taken += h * 0.5 * middle.squaredNorm();
  }
  State now = model.initial();
  now.t = until;
  const Node flying = model.expand(now)[0];
  BOOST_TEST((flying.position.head<2>() - x).norm() < 1e-7);
  BOOST_TEST((flying.velocity.head<2>() - v).norm() < 1e-7);
  // The energy of the flying node and of the common fall, with all that the air has taken.
  BOOST_TEST(std::abs(model.energy(now) - model.energy(model.initial())) < 1e-11);
  BOOST_TEST(std::abs(model.kinetic(now) + model.potential(now) + model.dissipated(now) -
                      model.energy(model.initial())) < 1e-10);
  BOOST_TEST(model.dissipated(now) > 3 * taken);
}

BOOST_AUTO_TEST_CASE(flights_are_right_for_any_air) {
  for (const double alpha : {1e-12, 1e-3, 0.05, 0.2, 3.0}) {
    const reduce::Flight flight{{3, -1, 2}, {0, 0, -9.81}, alpha};
    for (const double t : {1e-6, 0.3, 1.0, 5.0}) {
      using Long = long double;
      const Long x = Long(alpha) * t;
      // (t - (1 - e^-x)/alpha)/alpha by its series, or in long double.
      Long r = 0, term = Long(t) * t / 2;
      for (int n = 3; n < 150; ++n) r += term, term *= -x / n;
      const double expected =
          static_cast<double>(Long(t) * 2 + r * (Long(-9.81) - Long(alpha) * 2));
      BOOST_TEST(std::abs(flight.displacement(t)[2] - expected) <=
                 16 * 0x1p-52 * (2 * t + 10 * t * t));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
