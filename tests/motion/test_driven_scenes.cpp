// Scenes with supports that move and loads that change: how they are read and written, what is left
// out of them, and what theory says of their motions.
#include <cmath>
#include <numbers>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/fragments.hpp"
#include "tests/scene/refusal.hpp"

using namespace qddot;

BOOST_AUTO_TEST_SUITE(driven_scenes)

namespace {

const std::string springs = R"(
[[springs]]
nodes = [0, 1]
stiffness = 100.0
)";

Scene parsed(const std::string& text) { return parse_scene(text, "driven.toml", "."); }

const std::string shaken = R"(
dimension = 2
gravity_in_time = "push"
[[curves]]
name = "push"
polynomial = [[0.0, 0.0], [1.0, -2.0]]
[[curves]]
name = "quake"
harmonics = [{ amplitude = [0.1, 0.0], frequency = 2.0 },
             { amplitude = [0.0, 0.2], angular_frequency = 3.0, phase = 0.5 }]
table = { times = [0.0, 0.5, 2.0], values = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.3]], interpolation = "linear" }
[[nodes]]
position = [0.0, 0.0]
pinned = true
motion = "quake"
[[nodes]]
position = [1.0, 0.0]
mass = 2.0
load_in_time = { harmonics = [{ amplitude = [1.0, 1.0], frequency = 0.5 }] }
)" + springs;

// The end of a run.
std::vector<Node> moved(const Scene& scene, const char* method, double step_size, double until,
                        State* end = nullptr) {
  const Model model(scene);
  State state = model.initial();
  const Summary summary =
      make_integrator(*find_method(method), model.system(), {.step_size = step_size})
          ->advance(state, until);
  BOOST_TEST_REQUIRE(summary.message == "");
  if (end) *end = state;
  return model.expand(state);
}

}  // namespace

BOOST_AUTO_TEST_CASE(curves_are_read_and_written_to_the_bit) {
  const Scene scene = parsed(shaken);
  BOOST_TEST_REQUIRE(scene.curves.size() == 3);
  BOOST_TEST(scene.gravity_curve == 0);
  BOOST_TEST(scene.nodes[0].curve == 1);
  BOOST_TEST(scene.nodes[1].curve == 2);
  const TimeCurve& quake = scene.curves[1];
  BOOST_TEST(quake.harmonics[0].frequency == 4 * std::numbers::pi);  // Hz
  BOOST_TEST(quake.harmonics[1].phase == 0.5);
  BOOST_TEST((quake.at(0.25) -
              Eigen::Vector3d(0.1 * std::sin(std::numbers::pi) + 0.05, 0.2 * std::sin(1.25), 0))
                 .norm() < 1e-15);
  const Scene again = parsed(to_toml(scene));
  BOOST_TEST(content_hash(again) == content_hash(scene));
  for (const double t : {0.0, 0.3, 1.7, 5.0}) {
    for (std::size_t c = 0; c < 3; ++c) BOOST_TEST(again.curves[c].at(t) == scene.curves[c].at(t));
  }
  Scene other = scene;
  other.curves[1].harmonics[0].phase = 1e-9;
  BOOST_TEST(content_hash(other) != content_hash(scene));
}

BOOST_AUTO_TEST_CASE(meshes_and_generators_move_their_pins) {
  const Scene scene = parsed(R"(
[generator]
kind = "cloth"
nodes = 4
[[generator.motion]]
min = [-9, -9, -9]
max = [9, 9, 9]
curve = { polynomial = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]] }
[[generator.load]]
nodes = [5, 6]
force_in_time = { harmonics = [{ amplitude = [0.0, 0.0, 1.0], frequency = 1.0 }] }
)");
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    BOOST_TEST(node.curve == (i == 5 || i == 6 ? 0 : node.pinned ? 1 : -1));
  }
}

BOOST_AUTO_TEST_CASE(mistakes_are_told_in_a_sentence) {
  const auto refused = [](const std::string& nodes, const std::vector<std::string>& words) {
    const std::string text = "dimension = 1\n" + nodes + springs;
    const std::string told = refusal_of([&] { parsed(text); });
    BOOST_TEST(names_all(told, words), told);
  };
  const std::string end = "[[nodes]]\nposition = [1.0]\nmass = 1.0\n";
  const auto pin = [&](const std::string& motion) {
    return "[[nodes]]\nposition = [0.0]\npinned = true\nmotion = " + motion + "\n" + end;
  };
  refused(pin("{ harmonics = [{ amplitude = [1.0] }] }"),
          {"driven.toml:5: nodes[0].motion.harmonics[0].frequency", "exactly one of"});
  refused(pin("{ harmonics = [{ amplitude = [1.0, 2.0], frequency = 1.0 }] }"),
          {"amplitude", "arrays of 1 finite number"});
  refused(pin("{ }"), {"nodes[0].motion.polynomial", "needs one at least"});
  refused(pin("\"quake\""), {"nodes[0].motion: 'quake' is not allowed", "there are none"});
  refused(pin("{ table = { times = [0.0, 0.0], values = [[0.0], [1.0]] } }"),
          {"times", "that ascend"});
  refused(pin("{ table = { times = [0.0, 1.0], values = [[0.0]] } }"),
          {"values", "1 of them for 2"});
  refused(
      pin("{ table = { times = [0.0, 1.0], values = [[0.0], [1.0]], interpolation = \"cubic\" } }"),
      {"interpolation: 'cubic' is not allowed", "\"spline\" and \"linear\""});
  refused(
      "[[nodes]]\nposition = [0.0]\nmass = 1.0\nmotion = { polynomial = [[0.0], [1.0]] }\n" + end,
      {"nodes[0].motion", "it is for pinned nodes"});
  refused(
      "[[nodes]]\nposition = [0.0]\npinned = true\n[[nodes]]\nposition = [1.0]\nmass = 0.0\n"
      "load_in_time = { polynomial = [[0.0], [1.0]] }\n",
      {"nodes[1].curve", "not allowed on a node without mass"});
}

// In the frame of its supports, a net whose supports all move alike feels gravity g - s''.
BOOST_AUTO_TEST_CASE(supports_that_move_alike_are_gravity_in_the_moving_frame) {
  Scene net = generate(*find_generator("cloth"), {{"nodes", 5}}, "net");
  const double w = 9;
  const Eigen::Vector3d a(0.03, -0.02, 0.05), start = w * a;
  Scene shaken_net = net, pushed = net;
  shaken_net.curves = {{.harmonics = {{a, w, 0}}}};
  pushed.curves = {{.harmonics = {{w * w * a, w, 0}}}};  // -s''
  pushed.gravity_curve = 0;
  for (std::size_t i = 0; i < net.nodes.size(); ++i) {
    if (net.nodes[i].pinned) {
      shaken_net.nodes[i].curve = 0;
    } else {
      shaken_net.nodes[i].velocity += start;  // it moves with its supports at first
    }
  }
  const double until = 0.4;
  const auto one = moved(shaken_net, "kahan_li8", 1e-3, until),
             other = moved(pushed, "kahan_li8", 1e-3, until);
  const Eigen::Vector3d s = std::sin(w * until) * a;
  for (std::size_t i = 0; i < one.size(); ++i)
    BOOST_TEST((one[i].position - s - other[i].position).norm() < 1e-11);
}

BOOST_AUTO_TEST_CASE(reductions_hold_where_curves_share_them) {
  // Four pinned corners around a mass: in its plane and in two mirrors, at rest.
  Scene cross{.dimension = 3};
  cross.nodes = {{.position = {1, 0, 0}, .pinned = true}, {.position = {-1, 0, 0}, .pinned = true},
                 {.position = {0, 1, 0}, .pinned = true}, {.position = {0, -1, 0}, .pinned = true},
                 {.position = {0.3, 0.2, 0}, .mass = 1},  {.position = {-0.3, 0.2, 0}, .mass = 1}};
  for (const std::size_t pin : {0u, 2u, 3u}) cross.springs.push_back({{pin, 4}, {50, 0.5}});
  for (const std::size_t pin : {1u, 2u, 3u}) cross.springs.push_back({{pin, 5}, {50, 0.5}});
  cross.springs.push_back({{4, 5}, {80, 0.5}});
  const auto unknowns = [](const Scene& scene) { return Model(scene).system().size(); };
  BOOST_TEST(unknowns(cross) == 2);  // one mass, in the plane
  const auto with = [&](const std::vector<TimeCurve>& curves, std::array<int, 4> of_pins) {
    Scene scene = cross;
    scene.curves = curves;
    for (std::size_t i = 0; i < 4; ++i) scene.nodes[i].curve = of_pins[i];
    return scene;
  };
  const TimeCurve right{.harmonics = {{{0.1, 0, 0}, 7, 0.2}}},
      left = right.turned(-Eigen::Matrix3d::Identity());
  const TimeCurve up{.polynomial = {{0, 0, 0}, {0, 0.1, 0}}},
      out{.harmonics = {{{0, 0, 0.1}, 7, 0}}};
  // Mirrored: the pins on both sides move apart, or the one between along the plane.
  BOOST_TEST(unknowns(with({right, left}, {0, 1, -1, -1})) == 2);
  BOOST_TEST(unknowns(with({up}, {-1, -1, 0, -1})) == 2);
  // Not mirrored, and out of the plane.
  BOOST_TEST(unknowns(with({right}, {0, -1, -1, -1})) == 4);
  BOOST_TEST(unknowns(with({right, left}, {0, 0, -1, -1})) == 4);
  BOOST_TEST(unknowns(with({out}, {-1, -1, 0, -1})) == 3);
  // Whatever is left out, all nodes end where they do without reductions.
  for (const Scene& scene :
       {with({right, left}, {0, 1, -1, -1}), with({up, out}, {-1, -1, 0, 1})}) {
    const auto reduced = moved(scene, "rk8", 1e-3, 1);
    const Model full(scene, Reductions::only({}));
    State state = full.initial();
    make_integrator(*find_method("rk8"), full.system(), {.step_size = 1e-3})->advance(state, 1);
    const auto whole = full.expand(state);
    for (std::size_t i = 0; i < whole.size(); ++i)
      BOOST_TEST((whole[i].position - reduced[i].position).norm() < 1e-12);
  }
}

// Springs between supports, and supports that are elsewhere at t = 0 than drawn, count as well.
BOOST_AUTO_TEST_CASE(supports_alone_have_their_energy_and_work) {
  Scene scene{.dimension = 1};
  scene.curves = {{.harmonics = {{{0.2, 0, 0}, 3, std::numbers::pi / 2}}}};  // from 0.2 on
  scene.nodes = {{.pinned = true},
                 {.position = {1, 0, 0}, .pinned = true, .curve = 0},
                 {.position = {2, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {10, 1}}, {{1, 2}, {20, 0}}};
  const Model model(scene);
  const auto start = model.expand(model.initial());
  BOOST_TEST(std::abs(start[1].position[0] - 1.2) < 1e-15);
  BOOST_TEST(std::abs(model.potential(model.initial()) - (0.5 * 10 * 0.04 + 0.5 * 20 * 0.64)) <
             1e-14);
  State end;
  const auto nodes = moved(scene, "rk8", 1e-3, 1, &end);
  BOOST_TEST(std::abs(nodes[1].position[0] - (1 + 0.2 * std::cos(3))) < 1e-15);
  const double before = model.kinetic(model.initial()) + model.potential(model.initial());
  const double after = model.kinetic(end) + model.potential(end);
  BOOST_TEST(std::abs(after - before - model.driven(end)) < 1e-12);
  BOOST_TEST(std::abs(model.driven(end)) > 0.1);
  BOOST_TEST(std::abs(model.energy(end) - model.energy(model.initial())) < 1e-12);
}

// Gravity does not pull a massless node, so that a series through it is still seen to go slack.
BOOST_AUTO_TEST_CASE(gravity_in_time_leaves_series_through_massless_nodes) {
  Scene cable{.dimension = 2, .gravity = {0, -9.81, 0}};
  cable.curves = {{.harmonics = {{{0, 3, 0}, 5, 0}}}};
  cable.gravity_curve = 0;
  cable.nodes = {{.pinned = true},
                 {.position = {0.5, -0.9, 0}, .mass = 0},
                 {.position = {1, -1.8, 0}, .mass = 1}};
  cable.springs = {{{0, 1}, {100, 1}}, {{1, 2}, {100, 1}}};
  const Model model(cable, Reductions().without(Reduction::massless));
  BOOST_TEST(model.system().has_massless());
  BOOST_TEST((model.system().validity() != nullptr));
}

namespace {

// The growth of y'' = -(d + 2 e sin(2 t)) y in one period pi: the larger |eigenvalue| of the matrix
// that leads from (y, y') to the next, by 4000 steps of the classical Runge-Kutta method.
double floquet_growth(double d, double e) {
  constexpr int steps = 4000;
  const double h = std::numbers::pi / steps;
  Eigen::Matrix2d all;
  for (int column = 0; column < 2; ++column) {
    Eigen::Vector2d y = Eigen::Vector2d::Unit(column);
    const auto rate = [&](double t, const Eigen::Vector2d& at) {
      return Eigen::Vector2d(at[1], -(d + 2 * e * std::sin(2 * t)) * at[0]);
    };
    for (int i = 0; i < steps; ++i) {
      const double t = i * h;
      const Eigen::Vector2d k1 = rate(t, y), k2 = rate(t + h / 2, y + h / 2 * k1),
                            k3 = rate(t + h / 2, y + h / 2 * k2), k4 = rate(t + h, y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    all.col(column) = y;
  }
  const double half = all.trace() / 2;  // the determinant is 1
  return std::abs(half) > 1 ? std::abs(half) + std::sqrt(half * half - 1) : 1;
}

}  // namespace

// Inside of Mathieu's tongues the shaken pendulum grows by Floquet's factor, outside it does not.
BOOST_AUTO_TEST_CASE(a_shaken_pendulum_grows_inside_of_mathieus_tongues_alone) {
  const double g = 9.81, a = 0.05, stiffness = 1e6;
  int inside = 0;
  for (const double ratio : {1.7, 1.85, 1.95, 2.0, 2.06, 2.2, 1.0, 0.8}) {
    const double w = std::sqrt(g), W = ratio * w;  // of a length of 1 m
    const double period = 2 * std::numbers::pi / W;
    // With 2 s = W t: d = 4 g/W^2, 2 e = -4 a.
    const double expected = floquet_growth(4 * g / (W * W), -2 * a);
    Scene scene = generate(*find_generator("shaken_pendulum"),
                           {{"angle", 1e-8},
                            {"amplitude", a},
                            {"frequency", W / (2 * std::numbers::pi)},
                            {"stiffness", stiffness}},
                           "pendulum");
    // The spring starts as long as its weight keeps it.
    scene.nodes[1].position *= 1 + g / stiffness;
    const Model model(scene);
    State state = model.initial();
    const auto integrator =
        make_integrator(*find_method("blanes_moan6"), model.system(), {.step_size = period / 8000});
    const auto angle = [&] {
      const auto nodes = model.expand(state);
      const Eigen::Vector3d d = nodes[1].position - nodes[0].position;
      const Eigen::Vector3d v = nodes[1].velocity - nodes[0].velocity;
      return std::hypot(d[0], v[0] / w);
    };
    // The growth over many periods, after the part that decays has died.
    const int before = 30, periods = 30;
    integrator->advance(state, before * period);
    const double first = angle();
    integrator->advance(state, (before + periods) * period);
    const double growth = std::pow(angle() / first, 1.0 / periods);
    BOOST_TEST_CONTEXT("W/w = " << ratio << ": grows by " << growth << ", expected " << expected) {
      if (expected > 1.005) {
        ++inside;
        // The other part may be a few per cent after so many periods, over thirty more.
        BOOST_TEST(std::abs(growth / expected - 1) < 1e-3);
      } else {
        BOOST_TEST(growth < 1.02);  // the motion only beats
      }
    }
  }
  BOOST_TEST(inside >= 2);
}

BOOST_AUTO_TEST_SUITE_END()
