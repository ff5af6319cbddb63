#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/independent_linkage.hpp"
#include "tests/scene_draws.hpp"

namespace qddot {
inline namespace tests {

// A small valid scene with rods made by chance, and what is special about it. The same seed gives
// the same scene everywhere.
struct LinkageScene {
  Scene scene;
  std::string kind;
};

// Makes scenes of metres, whose velocities satisfy every rod and whose loops are not singular.
class LinkageScenes : SceneDraws {
 public:
  explicit LinkageScenes(std::uint64_t seed) : SceneDraws(seed) {}

  // The kinds of scenes that draw() makes.
  static const std::vector<std::string>& kinds() {
    static const std::vector<std::string> all = {"chain",  "tree",   "ring",   "net",    "four_bar",
                                                 "braced", "forest", "beside", "driven", "bead"};
    return all;
  }

  // One of these kinds, in the plane, in space, or flat in space; with dashpots and air on some.
  LinkageScene draw() {
    const std::string kind = kinds()[below(kinds().size())];
    // A start that is near a singular position is drawn again.
    for (int i = 0; i < 1000 && !draw_start(kind); ++i) continue;
    return {scene_, kind};
  }

 private:
  // A mass [kg] of this scene.
  double mass() { return std::pow(10, uniform(least_mass_, most_mass_)); }

  std::size_t add(const Vector& position, bool pinned = false) {
    scene_.nodes.push_back({.position = position, .mass = mass(), .pinned = pinned});
    return scene_.nodes.size() - 1;
  }
  void join(std::size_t i, std::size_t j) {
    SpringLaw law;
    law.rigid = true;
    scene_.springs.push_back({{i, j}, law});
  }
  // A new node at the end of a rod from another one.
  std::size_t grow(std::size_t from) {
    const double length = uniform(0.3, 1.5);
    const std::size_t node = add(scene_.nodes[from].position + length * direction());
    join(from, node);
    return node;
  }
  // A spring of some stretch, whose stiffness fits its lighter end.
  void stretch(std::size_t i, std::size_t j) {
    const Vector d = scene_.nodes[j].position - scene_.nodes[i].position;
    if (i == j || d.norm() < 0.1) return;
    const double lighter = lighter_end(i, j), w = uniform(2, 12), ratio = uniform(0.6, 1.3);
    const bool is_straight = is(0.2);
    SpringLaw law{.stiffness = lighter * w * w, .rest_length = is_straight ? 0 : ratio * d.norm()};
    scene_.springs.push_back({{i, j}, law});
  }
  double lighter_end(std::size_t i, std::size_t j) const {
    const Node &a = scene_.nodes[i], &b = scene_.nodes[j];
    if (a.pinned) return b.mass;
    return b.pinned ? a.mass : std::min(a.mass, b.mass);
  }

  bool draw_start(const std::string& kind);
  void add_kind(const std::string& kind);
  void add_tree(std::size_t root, std::size_t links, bool is_chain);
  void add_ring(std::size_t corners, bool is_free);
  void add_net(std::size_t rows, std::size_t columns);
  void add_four_bar();
  void add_braced(std::size_t more);
  void add_beads(std::size_t beads);
  void add_springs(std::size_t many);
  void move_supports();
  void lay_flat();
  void damp_some();
  void measure_rods();
  bool set_velocities();

  double least_mass_ = 0, most_mass_ = 0;
};

// Draws a scene of the kind; false if it has no such motion.
inline bool LinkageScenes::draw_start(const std::string& kind) {
  scene_ = {};
  scene_.dimension = 2 + static_cast<int>(below(2));
  const bool is_flat = scene_.dimension == 3 && is(0.15);
  if (is_flat) scene_.dimension = 2;
  // Most masses are of some kilograms; a few scenes have all sizes.
  const double spread = is(0.25) ? 2 : 0.5;
  least_mass_ = -spread;
  most_mass_ = spread;
  if (is(0.8)) scene_.gravity[1] = -9.81;
  if (is(0.1)) scene_.gravity = vector(6);
  add_kind(kind);
  if (kind == "beside" || is(0.2)) add_springs(1 + below(4));
  if (kind == "driven" || is(0.1)) move_supports();
  for (Node& node : scene_.nodes) {
    if (is(0.1)) node.load = vector(3 * node.mass);
  }
  if (is(0.2)) scene_.air_damping = uniform(0.1, 1.5);
  measure_rods();
  damp_some();
  const bool moves_well = set_velocities();
  if (is_flat) lay_flat();
  return moves_well;
}

inline void LinkageScenes::add_kind(const std::string& kind) {
  const bool hangs = is(0.7);
  if (kind == "chain") add_tree(add(vector(1), hangs), 1 + below(8), true);
  if (kind == "tree") add_tree(add(vector(1), hangs), 2 + below(8), false);
  if (kind == "beside") add_tree(add(vector(1), hangs), 1 + below(6), is(0.5));
  if (kind == "driven") add_tree(add(vector(1), true), 1 + below(5), is(0.6));
  if (kind == "ring") add_ring(3 + below(6), !hangs);
  if (kind == "net") {
    const std::size_t rows = 2 + below(2);
    add_net(rows, rows + below(5 - rows));
  }
  if (kind == "four_bar") add_four_bar();
  if (kind == "braced") add_braced(below(4));
  if (kind == "bead") add_beads(2 + below(3));
  if (kind == "forest") {
    const std::size_t trees = 2 + below(2);
    for (std::size_t k = 0; k < trees; ++k) {
      const bool is_pinned = is(0.5);
      add_tree(add(vector(1.5), is_pinned), 1 + below(3), is(0.5));
    }
    add_springs(1 + below(4));
  }
}

// Rods from a root, each from the last node or from any.
inline void LinkageScenes::add_tree(std::size_t root, std::size_t links, bool is_chain) {
  std::size_t last = root;
  for (std::size_t k = 0; k < links; ++k) {
    const std::size_t from = is_chain ? last : root + below(k + 1);
    last = grow(from);
  }
}

// A closed ring of rods, free or with one pin; in the plane a triangle is a body.
inline void LinkageScenes::add_ring(std::size_t corners, bool is_free) {
  const std::size_t first = scene_.nodes.size();
  const double size = uniform(0.5, 1.2);
  for (std::size_t k = 0; k < corners; ++k) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(corners);
    const Vector at = size * Vector(std::cos(angle), std::sin(angle), 0) + vector(0.25 * size);
    add(at, k == 0 && !is_free);
    if (k > 0) join(first + k - 1, first + k);
  }
  join(first, first + corners - 1);
}

// A grid of rods that are free to turn, with none, one or both upper corners pinned. The upper row
// is folded, as it could not move if it were straight between two pins.
inline void LinkageScenes::add_net(std::size_t rows, std::size_t columns) {
  const std::size_t pins = below(3);
  const double fold = uniform(0.1, 0.3);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const double up = (r + c) % 2 == 0 ? fold : -fold;
      const Vector at(0.6 * static_cast<double>(c), up - 0.7 * static_cast<double>(r), 0);
      const Vector off = vector(0.1);
      const bool is_corner = r == 0 && ((c == 0 && pins > 0) || (c == columns - 1 && pins > 1));
      const std::size_t node = add(at + off, is_corner);
      const bool is_fixed = is_corner && columns == 2 && c == 1;  // beside the other pin
      if (c > 0 && !is_fixed) join(node - 1, node);
      if (r > 0) join(node - columns, node);
    }
  }
}

// Two pins, and a chain of three rods from one to the other.
inline void LinkageScenes::add_four_bar() {
  const std::size_t first = add(Vector::Zero(), true);
  const Vector left = Vector(-0.2, uniform(-1, -0.4), 0) + vector(0.3);
  const Vector right = Vector(uniform(0.7, 1.3), uniform(-1, -0.4), 0) + vector(0.3);
  const std::size_t a = add(left);
  const std::size_t b = add(right);
  const std::size_t last = add(Vector(1, 0, 0) + vector(0.2), true);
  join(first, a);
  join(a, b);
  join(b, last);
  // Some have one more arm.
  if (is(0.4)) grow(is(0.5) ? a : b);
}

// A body: a triangle, or a tetrahedron in space, to which nodes are braced; it swings or is free.
inline void LinkageScenes::add_braced(std::size_t more) {
  const std::size_t first = scene_.nodes.size(),
                    braces = static_cast<std::size_t>(scene_.dimension);
  const bool is_pinned = is(0.5);
  add(vector(0.2), is_pinned);
  for (std::size_t k = 1; k <= braces + more; ++k) {
    const std::size_t node = add(scene_.nodes.back().position + uniform(0.6, 1.2) * direction());
    // Each of the first nodes is joined to all before it, the others to as many as hold them.
    const std::size_t from = k > braces ? node - braces : first;
    for (std::size_t other = from; other < node; ++other) join(other, node);
  }
}

// Masses on springs alone, beside others on rods from one pin.
inline void LinkageScenes::add_beads(std::size_t beads) {
  const std::size_t pin = add(Vector::Zero(), true);
  for (std::size_t k = 0; k < beads; ++k) {
    const bool is_free = is(0.4);
    const std::size_t node = is_free ? add(vector(1.2)) : grow(pin);
    stretch(below(node), node);
    if (is_free && is(0.5)) grow(node);
  }
}

// Springs between any nodes.
inline void LinkageScenes::add_springs(std::size_t many) {
  const std::size_t count = scene_.nodes.size();
  if (is(0.4)) {
    const std::size_t node = add(vector(1.2));
    stretch(below(count), node);
  }
  for (std::size_t k = 0; k < many; ++k) {
    const std::size_t i = below(count);
    const std::size_t j = below(count);
    if (!(scene_.nodes[i].pinned && scene_.nodes[j].pinned)) stretch(i, j);
  }
}

// Harmonic motions of pins that begin where the pins are drawn.
inline void LinkageScenes::move_supports() {
  for (Node& node : scene_.nodes) {
    if (!node.pinned || is(0.2)) continue;
    TimeCurve curve;
    const Vector amplitude = vector(0.25);
    const double frequency = uniform(1, 9);
    const double phase = is(0.5) ? 0 : uniform(-3, 3);
    curve.harmonics.push_back({amplitude, frequency, phase});
    if (phase != 0) curve.polynomial = {-amplitude * std::sin(phase)};
    node.curve = static_cast<int>(scene_.curves.size());
    scene_.curves.push_back(curve);
  }
}

// Turns a scene of the plane into space, with all that moves in it.
inline void LinkageScenes::lay_flat() {
  scene_.dimension = 3;
  const Vector a = direction();
  Vector b = direction().cross(a);
  if (b.norm() < 0.1) b = Vector(a[1], -a[0], 0) + Vector(0, a[2], -a[1]);
  b = (b - a * a.dot(b)).normalized();
  Eigen::Matrix3d turn;
  turn << a, b, a.cross(b);
  for (Node& node : scene_.nodes) {
    node.position = turn * node.position;
    node.velocity = turn * node.velocity;
    node.load = turn * node.load;
  }
  scene_.gravity = turn * scene_.gravity;
  for (TimeCurve& curve : scene_.curves) {
    curve.harmonics[0].amplitude = turn * curve.harmonics[0].amplitude;
    for (Vector& own : curve.polynomial) own = turn * own;
  }
  measure_rods();
}

// Rods are as long as they are drawn.
inline void LinkageScenes::measure_rods() {
  for (Spring& spring : scene_.springs) {
    const auto [i, j] = spring.nodes;
    if (spring.law.rigid)
      spring.law.rest_length = (scene_.nodes[j].position - scene_.nodes[i].position).norm();
  }
}

inline void LinkageScenes::damp_some() {
  if (!is(0.35)) return;
  const double share = uniform(0.3, 1), ratio = std::pow(10, uniform(-2, -0.3));
  for (Spring& spring : scene_.springs) {
    if (spring.law.rigid || !is(share)) continue;
    const double lighter = lighter_end(spring.nodes[0], spring.nodes[1]);
    spring.law.damping = ratio * std::sqrt(spring.law.stiffness * lighter);
  }
}

// Random velocities, laid on all rods by the independent model; and the end time, by which the
// motion turns by some radians. False if the start is near a singular position.
inline bool LinkageScenes::set_velocities() {
  // A pin and weights set a motion off by themselves.
  const bool falls = scene_.nodes[0].pinned && !scene_.gravity.isZero(0);
  const double size = falls && is(0.3) ? 0 : uniform(0.5, 3);
  const auto is_short = [](const Spring& spring) {
    return spring.law.rigid && spring.law.rest_length < 0.15;
  };
  const auto is_rod = [](const Spring& spring) { return spring.law.rigid; };
  if (std::ranges::any_of(scene_.springs, is_short)) return false;
  if (std::ranges::none_of(scene_.springs, is_rod)) return false;
  for (Node& node : scene_.nodes) {
    if (!node.pinned) node.velocity = vector(size);
  }
  const LinkageMotion laid(scene_);
  if (!laid.why_stopped().empty() || laid.conditioning() < 0.06L || laid.freedoms() == 0)
    return false;
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    Node& node = scene_.nodes[i];
    if (!node.pinned) node.velocity = laid.velocity(i);
    if (node.velocity.norm() > 12) return false;
  }
  const double turn = uniform(1, 3);
  const double swing = std::sqrt(scene_.gravity.norm() / 0.8);
  scene_.until = turn / std::max({0.7 * swing, static_cast<double>(laid.fastest_turn()), 1.0});
  return true;
}

}  // namespace tests
}  // namespace qddot
