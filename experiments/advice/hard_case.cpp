#include "experiments/advice/hard_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "experiments/advice/draws.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/reference/divergence.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::judged_advice {
namespace {

using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

Vector3d random_direction(Draws& draw, int d) {
  for (;;) {
    const Vector3d x = draw.in_box(d, 1);
    if (x.norm() > 0.1 && x.norm() < 1) return x.normalized();
  }
}

// Turns everything at random, in the plane or in space; a scene in the plane may come to lie in
// space.
void turn(Scene& scene, Draws& draw) {
  if (scene.dimension == 1) return;
  if (scene.dimension == 2 && draw.happens(0.4)) scene.dimension = 3;
  const Vector3d axis =
      scene.dimension == 2 ? Vector3d(0, 0, 1) : random_direction(draw, scene.dimension);
  const Eigen::Matrix3d r = Eigen::AngleAxisd(draw.between(0.1, 3), axis).toRotationMatrix();
  const auto turned = [&](const Vector3d& x) -> Vector3d { return r * x; };
  for (Node& node : scene.nodes) {
    node.position = turned(node.position);
    node.velocity = turned(node.velocity);
  }
  scene.gravity = turned(scene.gravity);
}

void join(Scene& scene, std::size_t i, std::size_t j, double k, double l0, double c = 0) {
  scene.springs.push_back({{i, j}, {.stiffness = k, .rest_length = l0, .quartic = c}});
}

double apart(const Scene& scene, std::size_t i, std::size_t j) {
  return (scene.nodes[i].position - scene.nodes[j].position).norm();
}

// The smallest and the largest natural frequency at the start [rad/s] may differ much; this is the
// largest.
double fastest(const HardCase& c) {
  const ReducedScene model = c.as_drawn();
  const double w = frequency_at_least(model.system(), model.initial().q);
  return w > 0 && std::isfinite(w) ? w : 1;
}

double largest_speed(const Scene& scene) {
  double v = 0;
  for (const Node& node : scene.nodes) v = std::max(v, node.velocity.norm());
  return v;
}

// A tree of nodes in a box of about `size` per node, with more springs between them; each spring is
// up to `strain` longer or shorter than at rest. The first node is pinned if asked for.
Scene net(Draws& draw, int d, int nodes, double strain, bool is_pinned) {
  Scene scene{.dimension = d};
  const double box = 0.7 * std::pow(nodes, 1.0 / d) + 0.3;
  for (int i = 0; i < nodes; ++i) {
    Node node{.mass = draw.by_logarithm(0.05, 3)};
    for (int attempt = 0; attempt < 200; ++attempt) {
      node.position = draw.in_box(d, box);
      if (std::ranges::all_of(scene.nodes, [&](const Node& other) {
            return (other.position - node.position).norm() > 0.35;
          }))
        break;
    }
    scene.nodes.push_back(node);
  }
  scene.nodes[0].pinned = is_pinned;
  const auto count = static_cast<std::size_t>(nodes);
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool is_of_tree = j == (i - 1) / 2 || j + 1 == i;
      if (!is_of_tree && !draw.happens(0.3)) continue;
      join(scene, j, i, draw.by_logarithm(3, 100),
           apart(scene, i, j) * (1 + strain * draw.between(-1, 1)));
    }
  }
  return scene;
}

// A mass flies past a pinned node, or past a free one, to which a spring ties it.
void near_miss(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  const double v = draw.by_logarithm(1, 30), b = draw.by_logarithm(1e-5, 0.1);
  c.scene = {.dimension = d};
  c.scene.nodes = {{.mass = draw.by_logarithm(0.3, 3), .pinned = draw.happens(0.7)},
                   {.position = {1, b, 0}, .velocity = {-v, 0, 0}, .mass = 1}};
  const double k = draw.by_logarithm(10, 300);
  join(c.scene, 0, 1, k, draw.between(0.2, 1.3));
  if (draw.happens(0.5)) {
    c.scene.nodes.push_back({.position = Vector3d(1, 0.6, 0) + draw.in_box(d, 1), .mass = 1});
    join(c.scene, 1, 2, k * draw.between(0.1, 0.5), apart(c.scene, 1, 2));
  }
  if (draw.happens(0.5)) turn(c.scene, draw);
  c.until = draw.by_logarithm(1.3, 40) / v;
}

void slow_orbit(HardCase& c, Draws& draw) {
  const double k = draw.happens(0.5) ? 100 : draw.by_logarithm(10, 1000);
  c.scene = generate(*find_generator("orbit"),
                     {{"stiffness", k},
                      {"radius", draw.between(1.2, 3)},
                      {"speed", draw.happens(0.2) ? 0 : draw.by_logarithm(1e-3, 1)}},
                     "orbit");
  c.until = draw.by_logarithm(0.5, 50) * 10 / std::sqrt(k);
}

// Two to four bodies that repel each other where they are near, and attract each other farther
// away.
void bounce(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const std::size_t bodies = draw.happens(0.6) ? 2 : 3 + static_cast<std::size_t>(draw.one_of(2));
  const PairLaw law{draw.happens(0.6) ? PairLaw::Form::lennard_jones : PairLaw::Form::morse,
                    draw.by_logarithm(0.01, 10), draw.between(0.5, 1.5)};
  const double speed = std::sqrt(law.depth) * draw.by_logarithm(0.03, 5);
  c.scene = {.dimension = d};
  double x = 0;
  for (std::size_t i = 0; i < bodies; ++i) {
    Node node{.position = {x, 0, 0}, .mass = draw.by_logarithm(0.3, 3)};
    node.velocity[0] = speed * (i == 0 ? 1 : i == 1 ? -1 : draw.between(-1, 1));
    for (int a = 1; a < d; ++a)
      node.position[a] = draw.between(-1, 1) * law.size * draw.by_logarithm(1e-3, 0.3);
    c.scene.nodes.push_back(node);
    x += law.size * draw.between(1.2, 4);
    for (std::size_t j = 0; j < i; ++j) c.pairs.push_back({j, i, law});
  }
  c.gives_stiffness = draw.happens(0.5);
  c.until = 1.5 * law.size / speed * draw.by_logarithm(1, 15);
}

// A body on an ellipse around a fixed centre, or around another body.
void planet(HardCase& c, Draws& draw) {
  const double eccentricity = 1 - draw.by_logarithm(3e-3, 0.6), a = draw.by_logarithm(0.3, 3);
  const bool is_fixed = draw.happens(0.5), is_far = draw.happens(0.8);
  const double sun = draw.by_logarithm(0.3, 3), own = is_fixed ? 1 : draw.by_logarithm(1e-4, 1);
  const double mu = is_fixed ? sun : sun + own;
  const double r = a * (is_far ? 1 + eccentricity : 1 - eccentricity);
  const double v = std::sqrt(mu * (2 / r - 1 / a));
  c.scene = {.dimension = 2 + draw.one_of(2)};
  c.scene.nodes = {{.position = {r, 0, 0}, .velocity = {0, v, 0}, .mass = own}};
  OwnPair pair{0, {}, {PairLaw::Form::gravity, sun * own, 1}};
  if (!is_fixed) {
    c.scene.nodes.push_back({.velocity = {0, -v * own / sun, 0}, .mass = sun});
    c.scene.nodes[0].velocity *= sun / mu, c.scene.nodes[1].velocity *= sun / mu;
    pair.other = 1;
  }
  c.pairs = {pair};
  if (c.scene.dimension == 3) turn(c.scene, draw);
  c.gives_stiffness = draw.happens(0.5);
  c.until = 2 * pi * std::sqrt(a * a * a / mu) * draw.by_logarithm(0.2, 10);
}

// A mass that moves along its spring, through the pinned end.
void through_the_pin(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const double k = draw.by_logarithm(5, 200), l0 = draw.between(0.3, 1.2);
  const bool is_quartic = draw.happens(0.3);
  const int axis = draw.one_of(d);
  c.scene = {.dimension = d};
  Node mass{.mass = draw.by_logarithm(0.1, 3)};
  mass.position[axis] = draw.between(0.7, 1.6);
  // More than the energy at length zero.
  const double v = std::sqrt(2 * (0.5 * k * l0 * l0) / mass.mass) * draw.between(0.3, 3);
  if (draw.happens(0.7)) mass.velocity[axis] = -v;
  if (draw.happens(0.5)) c.scene.gravity[axis] = -9.81;
  c.scene.nodes = {{.pinned = true}, mass};
  join(c.scene, 0, 1, is_quartic ? 0 : k, l0, is_quartic || draw.happens(0.2) ? 4 * k : 0);
  if (d == 1 && draw.happens(0.3)) {
    c.scene.nodes.push_back({.position = {mass.position[0] + 0.8, 0, 0}, .mass = 0.5});
    join(c.scene, 1, 2, k, 0.7);
  }
  c.until = std::sqrt(mass.mass / k) * draw.by_logarithm(1, 60);
}

void fold(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  c.scene = net(draw, d, 4 + draw.one_of(5), 0.3, draw.happens(0.7));
  const double v = draw.by_logarithm(1, 20);
  for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, v);
  if (d == 2 && draw.happens(0.5)) turn(c.scene, draw);
  c.until = draw.by_logarithm(1, 30) / v;
}

// A column between two pins, or one that springs hold from the side, pressed a little more than it
// can bear.
void column(HardCase& c, Draws& draw) {
  const double k = draw.by_logarithm(100, 1e4), m = draw.by_logarithm(0.03, 1);
  const double bend = draw.happens(0.15) ? 0 : draw.by_logarithm(1e-10, 1e-2);
  double rate = 0;
  if (draw.happens(0.5)) {
    const int nodes = 3 + draw.one_of(11);
    const double compression = 1 - draw.by_logarithm(1e-3, 0.2);
    c.scene = generate(*find_generator("strut"),
                       {{"nodes", nodes},
                        {"mass", m},
                        {"stiffness", k},
                        {"compression", compression},
                        {"bend", bend}},
                       "strut");
    const double s = std::sin(pi / (2 * (nodes - 1)));
    rate = 2 * std::sqrt(k / m * (1 / compression - 1)) * s;
  } else {
    const double compression = 1 - draw.by_logarithm(1e-2, 0.2);
    const double held = 2 * k * (1 / compression - 1) / (1 + draw.by_logarithm(1e-3, 1));
    c.scene = {.dimension = 2};
    c.scene.nodes = {{.position = {-1, 0, 0}, .pinned = true},
                     {.position = {1, 0, 0}, .pinned = true},
                     {.position = {0, bend, 0}, .mass = m},
                     {.position = {0, -2, 0}, .pinned = true}};
    join(c.scene, 0, 2, k, 1 / compression);
    join(c.scene, 1, 2, k, 1 / compression);
    join(c.scene, 2, 3, held, 2);
    rate = std::sqrt((2 * k * (1 / compression - 1) - held) / m);
  }
  if (draw.happens(0.5)) turn(c.scene, draw);
  c.until = draw.between(0.5, 25) / rate;
}

// A hanging chain or a net of masses from 1 to 1e-8 kg.
void uneven_masses(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  c.scene = net(draw, d, 3 + draw.one_of(6), 0.1, true);
  const double lightest = draw.by_logarithm(1e-8, 1e-2);
  for (Node& node : c.scene.nodes) {
    node.mass = draw.by_logarithm(lightest, 1);
    node.velocity = draw.in_box(d, 1);
  }
  if (draw.happens(0.5)) c.scene.gravity[d - 1] = -9.81;
  // The light ones start near rest in half of the cases: else they alone are seen.
  if (draw.happens(0.5)) {
    for (Node& node : c.scene.nodes) node.velocity *= std::min(1.0, node.mass / 0.1);
  }
  c.until = 2 * pi / fastest(c) * draw.by_logarithm(3, 2000);
}

void weakly_coupled(HardCase& c, Draws& draw) {
  const double k = draw.by_logarithm(10, 1000), coupling = k * draw.by_logarithm(1e-7, 3e-2);
  const bool is_on_line = draw.happens(0.3);
  const double quartic = draw.happens(0.6) ? k : 0;
  c.scene = {.dimension = is_on_line ? 1 : 2};
  c.scene.nodes = {{.pinned = true},
                   {.position = {1, 0, 0}, .mass = 1},
                   {.position = {2, 0, 0}, .mass = draw.happens(0.5) ? 1 : draw.between(0.3, 3)},
                   {.position = {3, 0, 0}, .pinned = true}};
  c.scene.nodes[1].velocity = draw.in_box(c.scene.dimension, 0.4 * std::sqrt(k));
  join(c.scene, 0, 1, k, draw.happens(0.5) ? 1 : 0.7, quartic);
  join(c.scene, 2, 3, k, draw.happens(0.5) ? 1 : 0.7, quartic);
  join(c.scene, 1, 2, coupling, 1);
  if (draw.happens(0.3)) turn(c.scene, draw);
  c.until = 2 * pi / std::sqrt(k) * draw.by_logarithm(2, 1000);
}

// At rest, in a stable or an unstable place, or nearly so.
void equilibrium_start(HardCase& c, Draws& draw) {
  const double push = draw.happens(0.4) ? 0 : draw.by_logarithm(1e-10, 1e-2);
  const int form = draw.one_of(4), d = 2 + draw.one_of(2);
  double w = 1;
  if (form == 0) {  // hanging where it rests
    Scene scene = net(draw, d, 3 + draw.one_of(4), 0.05, true);
    for (Spring& spring : scene.springs) spring.law.stiffness *= 20;
    scene.gravity[d - 1] = -9.81;
    try {
      scene = settled(scene, "net");
    } catch (const std::exception&) {
    }
    c.scene = scene;
  } else if (form == 1) {  // a free net at rest length
    c.scene = net(draw, d, 3 + draw.one_of(4), 0, draw.happens(0.5));
  } else if (form == 2) {  // upside down
    const double k = draw.by_logarithm(100, 1e4), m = draw.by_logarithm(0.1, 1);
    const double length = 1;
    c.scene = {.dimension = d};
    c.scene.gravity[1] = -9.81;
    c.scene.nodes = {{.pinned = true}, {.position = {0, length, 0}, .mass = m}};
    join(c.scene, 0, 1, k, length + m * 9.81 / k);
    w = 2 * pi * std::sqrt(9.81 / length);
  } else {  // between two pins, too long for their distance
    const double k = draw.by_logarithm(50, 1000), l0 = draw.between(1.01, 1.4);
    c.scene = {.dimension = d};
    c.scene.nodes = {{.position = {-1, 0, 0}, .pinned = true},
                     {.position = {1, 0, 0}, .pinned = true},
                     {.position = {draw.happens(0.5) ? 0 : 0.1, 0, 0}, .mass = 1}};
    join(c.scene, 0, 2, k, l0);
    join(c.scene, 1, 2, k, l0);
    w = 2 * pi * std::sqrt(2 * k * (l0 - 1));
    turn(c.scene, draw);
  }
  const Vector3d direction = random_direction(draw, c.scene.dimension);
  for (Node& node : c.scene.nodes) {
    if (push > 0 && !node.pinned) node.velocity = push * direction;
  }
  if (form < 2) w = fastest(c);
  c.until = 2 * pi / w * draw.by_logarithm(0.5, form < 2 ? 300 : 30);
}

// Motions by 1e-3 to 1e-11 of what is drawn.
void small_motion(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const double size = draw.by_logarithm(1e-11, 1e-3);
  c.scene = net(draw, d, 2 + draw.one_of(6), 0, true);
  for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, size);
  c.until = 2 * pi / fastest(c) * draw.by_logarithm(0.5, 1000);
}

// A mass comes slowly from afar, with a fast small vibration on it, and passes the pinned end
// closely before the end. Or a stiff pendulum stands nearly upright, and falls late.
void late_event(HardCase& c, Draws& draw) {
  if (draw.happens(0.5)) {
    const double k = draw.by_logarithm(0.1, 10), far = draw.between(2, 6);
    const double ratio = draw.by_logarithm(10, 200), light = draw.by_logarithm(1e-3, 0.1);
    const double l0 = draw.between(0.05, 0.5);
    c.scene = {.dimension = 2 + draw.one_of(2)};
    c.scene.nodes = {{.pinned = true},
                     {.position = {far, 0, 0},
                      .velocity = {0, far * std::sqrt(k) * draw.by_logarithm(1e-3, 0.05), 0},
                      .mass = 1},
                     {.position = {far + 0.3, 0.2, 0}, .velocity = {0, 0, 0}, .mass = light}};
    join(c.scene, 0, 1, k, l0);
    join(c.scene, 1, 2, light * k * ratio * ratio, apart(c.scene, 1, 2) * draw.between(0.9, 1));
    if (draw.happens(0.5)) turn(c.scene, draw);
    const double passes = 0.5 * pi * std::sqrt(1 / k);
    c.until = passes * draw.between(1.02, 1.4);
  } else {
    const double k = draw.by_logarithm(1e2, 1e5), away = draw.by_logarithm(1e-9, 1e-2);
    c.scene = {.dimension = 2};
    c.scene.gravity[1] = -9.81;
    c.scene.nodes = {{.pinned = true},
                     {.position = {std::sin(away), std::cos(away), 0}, .mass = 1}};
    join(c.scene, 0, 1, k, 1 + draw.between(0, 2) * 9.81 / k);
    if (draw.happens(0.5)) {
      c.scene.nodes.push_back({.position = {0, 2, 0}, .mass = 0.1});
      join(c.scene, 1, 2, k / 10, apart(c.scene, 1, 2));
    }
    const double falls = std::log(pi / away) / std::sqrt(9.81);
    c.until = falls * draw.between(0.8, 1.4);
  }
}

// The last tenth before the positions of a chaotic motion are lost, as a run of a pilot with a
// start moved by 1e-12 says; or a regular motion's whole time.
void before_horizon(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  if (draw.happens(0.5)) {  // an elastic pendulum of two or three links
    c.scene = {.dimension = d};
    c.scene.gravity[1] = -9.81;
    c.scene.nodes = {{.pinned = true}};
    Vector3d end = Vector3d::Zero();
    const int links = 2 + draw.one_of(2);
    for (int i = 0; i < links; ++i) {
      end += random_direction(draw, d);
      c.scene.nodes.push_back({.position = end, .mass = draw.by_logarithm(0.3, 3)});
      const auto own = static_cast<std::size_t>(i);
      join(c.scene, own, own + 1, draw.by_logarithm(100, 3000), 1);
    }
  } else {
    c.scene = net(draw, d, 4 + draw.one_of(4), 0.3, true);
    for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, 3);
  }
  const double longest = 2 * pi / fastest(c) * 150;
  const ReducedScene model = c.as_drawn();
  std::vector<double> times;
  for (int i = 1; i <= 300; ++i) times.push_back(longest * i / 300);
  const auto path_of = [&](const State& start) {
    std::vector<Vec> path;
    const auto integrator = make_integrator(*find_method("dprkn12"), model.system(),
                                            options_for(*find_method("dprkn12"), 1e-12, model));
    State state = start;
    integrator->advance(state, longest, {times, [&](const State& s) { path.push_back(s.q); }});
    return path;
  };
  State moved = model.initial();
  for (Index i = 0; i < moved.q.size(); ++i) moved.q[i] += 1e-12 * draw.between(-1, 1);
  const auto one = path_of(model.initial()), other = path_of(moved);
  c.until = longest;
  for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i) {
    // A rounding is some four digits less than that: it is as large as this a little later.
    const double gap = (one[i] - other[i]).cwiseAbs().maxCoeff() * 1e-4;
    if (gap > 0.03 * c.accuracy) {
      c.until = times[i];
      break;
    }
  }
  c.until *= draw.between(0.9, 1);
}

// A grid in a frame, all of it in tension, that is plucked.
void prestressed(HardCase& c, Draws& draw) {
  const int side = 3 + draw.one_of(4), d = draw.happens(0.7) ? 3 : 2;
  const double stretch = draw.by_logarithm(1.02, 4), k = draw.by_logarithm(30, 3000);
  c.scene = {.dimension = d};
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * side + j); };
  const double m = draw.by_logarithm(0.01, 1);
  const double pluck = draw.by_logarithm(1e-6, 0.5);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const bool edge = i == 0 || j == 0 || i + 1 == side || j + 1 == side;
      Node node{.position = Vector3d(i, j, 0), .mass = m, .pinned = edge};
      if (!edge && draw.happens(0.5)) node.position += draw.in_box(d, pluck);
      c.scene.nodes.push_back(node);
    }
  }
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      if (i + 1 < side) join(c.scene, at(i, j), at(i + 1, j), k, 1 / stretch);
      if (j + 1 < side) join(c.scene, at(i, j), at(i, j + 1), k, 1 / stretch);
    }
  }
  if (draw.happens(0.5)) turn(c.scene, draw);
  c.until = 2 * pi * std::sqrt(m / k) * draw.by_logarithm(0.5, 300);
}

// A free net that spins, moves, and may fall.
void spinning(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  c.scene = net(draw, d, 2 + draw.one_of(6), draw.happens(0.5) ? 0 : 0.1, false);
  const double stiffer = draw.by_logarithm(1, 100);
  for (Spring& spring : c.scene.springs) spring.law.stiffness *= stiffer;
  const double w = fastest(c) * draw.by_logarithm(0.003, 0.7);
  const Vector3d axis = d == 2 ? Vector3d(0, 0, 1) : random_direction(draw, 3);
  const Vector3d along = draw.happens(0.5) ? draw.in_box(d, 2) : Vector3d(0, 0, 0);
  for (Node& node : c.scene.nodes) node.velocity = along + w * axis.cross(node.position);
  if (draw.happens(0.4)) c.scene.gravity[1] = -9.81;
  c.until = 2 * pi / w * draw.by_logarithm(0.3, 30);
}

// The time from one greatest distance to the next of a mass on one spring, by the midpoint rule
// after r = middle - half cos(s): the integrand is then smooth and periodic.
double radial_period(double m, double k, double l0, double r, double v) {
  const double energy = 0.5 * m * v * v + 0.5 * k * (r - l0) * (r - l0), spin = r * v;
  const auto rest = [&](double x) {
    return 2 / m * (energy - 0.5 * k * (x - l0) * (x - l0)) - spin * spin / (x * x);
  };
  // r is a turning point; the other lies where the rest changes its sign again.
  const double circle = std::max(r * 1e-3, std::pow(m * spin * spin / k, 0.25));
  const bool is_outer = rest(r * (1 - 1e-6)) > 0;
  double inside = is_outer ? r * (1 - 1e-6) : r * (1 + 1e-6);
  double outside = inside;
  for (int i = 0; i < 10000 && rest(outside) > 0; ++i) {
    inside = outside;
    outside *= is_outer ? 0.99 : 1.01;
  }
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (inside + outside);
    (rest(middle) > 0 ? inside : outside) = middle;
  }
  const double other = 0.5 * (inside + outside), middle = 0.5 * (r + other);
  const double half = 0.5 * std::abs(r - other);
  (void)circle;
  double sum = 0;
  constexpr int points = 2000;
  for (int i = 0; i < points; ++i) {
    const double s = pi * (i + 0.5) / points;
    sum += half * std::sin(s) / std::sqrt(rest(middle - half * std::cos(s)));
  }
  return 2 * sum * pi / points;
}

// The end is a whole number of the motion's periods.
void commensurate(HardCase& c, Draws& draw) {
  const double k = draw.by_logarithm(10, 1000), m = draw.by_logarithm(0.1, 3);
  const double l0 = draw.between(0.5, 1.2), r = l0 * draw.between(1.05, 2.5);
  const int times = draw.whole(1, 200), form = draw.one_of(4);
  c.scene = {.dimension = draw.happens(0.5) ? 2 : 3};
  c.scene.nodes = {{.pinned = true}, {.position = {r, 0, 0}, .mass = m}};
  double period = 2 * pi * std::sqrt(m / k);
  if (form <= 1) {
    const double circular = std::sqrt(k / m * (r - l0) * r);
    const double v = form == 0 ? circular : circular * draw.between(0.3, 0.9);
    c.scene.nodes[1].velocity =
        c.scene.dimension == 2 ? Vector3d(0, v, 0) : Vector3d(0, 0.8 * v, 0.6 * v);
    join(c.scene, 0, 1, k, l0);
    period = form == 0 ? 2 * pi * r / v : radial_period(m, k, l0, r, v);
  } else if (form == 2) {  // linear, with other frequencies in whole ratios
    c.scene.nodes[1].velocity = draw.in_box(c.scene.dimension, 3);
    join(c.scene, 0, 1, k, 0);
    for (std::size_t i = 2; i < 4; ++i) {
      const double n = 2 + draw.one_of(9);
      c.scene.nodes.push_back({.position = draw.in_box(c.scene.dimension, 1), .mass = m});
      join(c.scene, 0, i, n * n * k, 0);
    }
  } else {  // along a line through rest, where the spring does not turn over
    c.scene.dimension = 1;
    c.scene.nodes[1].position[0] = l0 * draw.between(1.05, 1.9);
    join(c.scene, 0, 1, k, l0);
  }
  c.until = times * period;
}

// Springs without stiffness at the start.
void quartic(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3), nodes = 2 + draw.one_of(4);
  c.scene = {.dimension = d};
  const double v = draw.by_logarithm(0.01, 2), stiff = draw.by_logarithm(1, 1000);
  for (int i = 0; i < nodes; ++i) {
    Node node{.position = Vector3d(i, 0, 0), .velocity = draw.in_box(d, v), .mass = 1};
    if (d > 1) node.position[1] = draw.between(-0.5, 0.5);
    if (draw.happens(0.3)) node.velocity.setZero();
    c.scene.nodes.push_back(node);
  }
  c.scene.nodes[0].pinned = true;
  if (largest_speed(c.scene) == 0) c.scene.nodes[1].velocity[0] = v;
  const double strain = draw.happens(0.5) ? 0 : draw.by_logarithm(1e-3, 0.2);
  for (std::size_t i = 1; i < c.scene.nodes.size(); ++i) {
    join(c.scene, i - 1, i, 0, apart(c.scene, i - 1, i) * (1 + strain * draw.between(-1, 1)),
         stiff);
  }
  c.until = std::pow(stiff * v * v, -0.25) * draw.by_logarithm(1, 60);
}

// Some springs are 1e3 to 1e6 times as stiff as the others, and named.
void stiff(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  c.scene = net(draw, d, 4 + draw.one_of(5), draw.happens(0.5) ? 0.02 : 0, true);
  const double ratio = draw.by_logarithm(1e2, 1e6);
  for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, draw.by_logarithm(0.1, 2));
  bool any = false;
  for (Spring& spring : c.scene.springs) {
    if (!draw.happens(0.4)) continue;
    spring.law.stiffness *= ratio;
    any = true;
  }
  if (!any) c.scene.springs[0].law.stiffness *= ratio;
  c.scene.stiff_above = 100.5;
  c.until = 2 * pi / fastest(c) * draw.by_logarithm(3, 2000);
}

// Masses on cables of massless joints, in tension at the start.
void massless_joints(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  c.scene = {.dimension = d};
  const double k = draw.by_logarithm(100, 1e4), m = draw.by_logarithm(0.1, 3);
  if (draw.happens(0.5)) {  // a joint that three cables meet in
    c.scene.nodes = {{.position = {-1, 1, 0}, .pinned = true},
                     {.position = {1, 1, 0}, .pinned = true},
                     {.position = {draw.between(-0.3, 0.3), 0.2, 0}, .mass = 0},
                     {.position = {draw.between(-0.3, 0.3), -0.8, 0}, .mass = m}};
    const double taut = draw.between(0.005, 0.2);
    for (const auto& [i, j] : {std::pair{0, 2}, {1, 2}, {2, 3}}) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      join(c.scene, a, b, k * draw.between(0.5, 2), apart(c.scene, a, b) * (1 - taut));
    }
    c.scene.gravity[1] = -9.81;
  } else {  // a cable with joints between its masses
    const int masses = 1 + draw.one_of(4), joints = 1 + draw.one_of(2);
    const double taut = draw.by_logarithm(0.003, 0.3);
    const int count = (masses + 1) * (joints + 1) + 1;
    for (int i = 0; i < count; ++i) {
      Node node{.position = Vector3d(0.3 * i, 0, 0)};
      node.pinned = i == 0 || i + 1 == count;
      if (!node.pinned && i % (joints + 1) == 0) {
        node.mass = m;
        node.position += draw.in_box(d, 0.3 * taut);
      }
      c.scene.nodes.push_back(node);
      if (i > 0)
        join(c.scene, static_cast<std::size_t>(i - 1), static_cast<std::size_t>(i), k,
             0.3 * (1 - taut));
    }
    if (draw.happens(0.5)) c.scene.gravity[1] = -9.81;
  }
  for (Node& node : c.scene.nodes) {
    if (node.mass > 0) node.velocity = draw.in_box(d, draw.by_logarithm(0.01, 1));
  }
  c.until = 2 * pi * std::sqrt(m / k) * draw.by_logarithm(0.5, 100);
}

struct HardKind {
  const char* name;
  void (*draw)(HardCase& c, Draws& draw);
};

constexpr std::array hard_motions = {HardKind{"near miss", near_miss},
                                     HardKind{"slow orbit", slow_orbit},
                                     HardKind{"bounce", bounce},
                                     HardKind{"planet", planet},
                                     HardKind{"through the pin", through_the_pin},
                                     HardKind{"fold", fold},
                                     HardKind{"column", column},
                                     HardKind{"uneven masses", uneven_masses},
                                     HardKind{"weakly coupled", weakly_coupled},
                                     HardKind{"equilibrium", equilibrium_start},
                                     HardKind{"small motion", small_motion},
                                     HardKind{"late event", late_event},
                                     HardKind{"before horizon", before_horizon},
                                     HardKind{"prestressed", prestressed},
                                     HardKind{"spinning", spinning},
                                     HardKind{"commensurate", commensurate},
                                     HardKind{"quartic", quartic},
                                     HardKind{"stiff", stiff},
                                     HardKind{"massless joints", massless_joints}};

State start_of(const Scene& scene) {
  const auto d = static_cast<Index>(scene.dimension);
  const Index n = static_cast<Index>(scene.nodes.size()) * d;
  State state{0, Vec(n), Vec(n)};
  for (Index i = 0; i < n; ++i) {
    const Node& node = scene.nodes[static_cast<std::size_t>(i / d)];
    state.q[i] = node.position[i % d];
    state.v[i] = node.velocity[i % d];
  }
  return state;
}

ReducedScene model_of(const HardCase& c, const Reductions& reductions) {
  if (c.pairs.empty()) return ReducedScene(c.scene, reductions);
  return ReducedScene(system_of_pairs(c.scene.nodes, c.scene.dimension, c.pairs, c.gives_stiffness),
                      start_of(c.scene), c.scene.dimension);
}

}  // namespace

ReducedScene HardCase::model() const { return model_of(*this, {}); }
ReducedScene HardCase::as_drawn() const {
  return model_of(*this, Reductions::only({Reduction::pins}));
}

std::size_t hard_kinds() { return hard_motions.size(); }

HardCase hard_case(std::uint64_t number) {
  Draws draw(number ^ 0x5851f42d4c957f2d);
  const HardKind& kind = hard_motions[(number / 3) % hard_motions.size()];
  HardCase c{.number = number,
             .kind = kind.name,
             .accuracy = draw.by_logarithm(1e-10, 1e-1),
             .of = static_cast<AccuracyOf>(number % 3)};
  kind.draw(c, draw);
  c.scene.name = fmt::format("case {} ({})", number, kind.name);
  c.scene.until = c.until;
  return c;
}

}  // namespace qddot::judged_advice
