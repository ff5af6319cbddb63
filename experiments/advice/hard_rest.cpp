#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/advice/hard_kinds.hpp"
#include "experiments/advice/hard_scenes.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::judged_advice {

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
    const double s = std::sin(std::numbers::pi / (2 * (nodes - 1)));
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
    const bool is_pinned = draw.happens(0.5);
    c.scene = net(draw, d, 3 + draw.one_of(4), 0, is_pinned);
  } else if (form == 2) {  // upside down
    const double k = draw.by_logarithm(100, 1e4), m = draw.by_logarithm(0.1, 1);
    const double length = 1;
    c.scene = {.dimension = d};
    c.scene.gravity[1] = -9.81;
    c.scene.nodes = {{.pinned = true}, {.position = {0, length, 0}, .mass = m}};
    join(c.scene, 0, 1, k, length + m * 9.81 / k);
    w = 2 * std::numbers::pi * std::sqrt(9.81 / length);
  } else {  // between two pins, too long for their distance
    const double k = draw.by_logarithm(50, 1000), l0 = draw.between(1.01, 1.4);
    c.scene = {.dimension = d};
    c.scene.nodes = {{.position = {-1, 0, 0}, .pinned = true},
                     {.position = {1, 0, 0}, .pinned = true},
                     {.position = {draw.happens(0.5) ? 0 : 0.1, 0, 0}, .mass = 1}};
    join(c.scene, 0, 2, k, l0);
    join(c.scene, 1, 2, k, l0);
    w = 2 * std::numbers::pi * std::sqrt(2 * k * (l0 - 1));
    turn(c.scene, draw);
  }
  const Eigen::Vector3d direction = random_direction(draw, c.scene.dimension);
  for (Node& node : c.scene.nodes) {
    if (push > 0 && !node.pinned) node.velocity = push * direction;
  }
  if (form < 2) w = fastest(c);
  c.until = 2 * std::numbers::pi / w * draw.by_logarithm(0.5, form < 2 ? 300 : 30);
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
  c.until = 2 * std::numbers::pi / std::sqrt(k) * draw.by_logarithm(2, 1000);
}

void quartic(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3), nodes = 2 + draw.one_of(4);
  c.scene = {.dimension = d};
  const double v = draw.by_logarithm(0.01, 2), stiff = draw.by_logarithm(1, 1000);
  for (int i = 0; i < nodes; ++i) {
    Node node{.position = Eigen::Vector3d(i, 0, 0), .velocity = draw.in_box(d, v), .mass = 1};
    if (d > 1) node.position[1] = draw.between(-0.5, 0.5);
    if (draw.happens(0.3)) node.velocity.setZero();
    c.scene.nodes.push_back(node);
  }
  c.scene.nodes[0].pinned = true;
  c.scene.nodes[1].velocity[0] = v;
  const double strain = draw.happens(0.5) ? 0 : draw.by_logarithm(1e-3, 0.2);
  for (std::size_t i = 1; i < c.scene.nodes.size(); ++i) {
    join(c.scene, i - 1, i, 0, apart(c.scene, i - 1, i) * (1 + strain * draw.between(-1, 1)),
         stiff);
  }
  c.until = std::pow(stiff * v * v, -0.25) * draw.by_logarithm(1, 60);
}

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
    const int masses = 1 + draw.one_of(3), joints = 1 + draw.one_of(2);
    const double taut = draw.by_logarithm(0.003, 0.3);
    const int count = (masses + 1) * (joints + 1) + 1;
    for (int i = 0; i < count; ++i) {
      Node node{.position = Eigen::Vector3d(0.3 * i, 0, 0)};
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
    if (node.mass > 0) node.velocity = draw.in_box(d, draw.by_logarithm(0.01, 5));
  }
  c.until = 2 * std::numbers::pi * std::sqrt(m / k) * draw.by_logarithm(0.3, 30);
}

}  // namespace qddot::judged_advice
