#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/settle.hpp"
#include "tests/scene_draws.hpp"

namespace qddot {
inline namespace tests {

// A small motion about an equilibrium, made by chance, and what is special about it.
struct SmallScene {
  Scene scene;
  std::string kind;
  double size = 0;  // of its displacements, as a part of a metre
};

// Makes nets of about a metre that vibrate a little. The same seed gives the same scene everywhere.
class SmallScenes : SceneDraws {
 public:
  explicit SmallScenes(std::uint64_t seed) : SceneDraws(seed) {}

  // The kinds of scenes that draw() makes.
  static const std::vector<std::string>& kinds() {
    static const std::vector<std::string> all = {"string", "net",  "lattice", "hanging",
                                                 "column", "pair", "loose"};
    return all;
  }

  SmallScene draw() {
    const std::string kind = kinds()[below(kinds().size())];
    double size = 0;
    while (!draw_start(kind, size)) continue;
    return {scene_, kind, size};
  }

 private:
  std::size_t add(const Vector& position, bool pinned = false) {
    const double mass = 0.02 * power(-mass_spread_, mass_spread_);
    scene_.nodes.push_back({.position = position, .mass = mass, .pinned = pinned});
    return scene_.nodes.size() - 1;
  }
  // A spring that is drawn at (1 + strain) times its rest length.
  void join(std::size_t i, std::size_t j, double strain, double stiffness = 1000) {
    const double l = (scene_.nodes[j].position - scene_.nodes[i].position).norm();
    SpringLaw law{.stiffness = stiffness * power(-stiffness_spread_, stiffness_spread_),
                  .rest_length = l / (1 + strain)};
    if (has_quartic_) law.quartic = law.stiffness / (l * l);
    scene_.springs.push_back({{i, j}, law});
  }

  bool draw_start(const std::string& kind, double& size);
  void add_string(const Vector& from, const Vector& to, std::size_t nodes, double strain);
  void add_net(std::size_t rows, double strain);
  void add_lattice(double strain);
  void add_hanging();

  double mass_spread_ = 0, stiffness_spread_ = 0;
  bool has_quartic_ = false;
};

// Draws a scene of the kind; false if it has no equilibrium nearby.
inline bool SmallScenes::draw_start(const std::string& kind, double& size) {
  scene_ = {};
  scene_.dimension = is(0.7) ? 3 : 2;
  mass_spread_ = is(0.3) ? 1 : 0.1;
  stiffness_spread_ = is(0.3) ? 0.5 : 0;
  has_quartic_ = is(0.15);
  const double strain = power(-2.5, -0.3);
  if (kind == "string") add_string({0, 0, 0}, {1, 0, 0}, 2 + below(16), strain);
  if (kind == "net") add_net(3 + below(5), strain);
  if (kind == "lattice") add_lattice(is(0.5) ? 0 : 0.1 * strain);
  if (kind == "hanging") add_hanging();
  if (kind == "column") add_lattice(-power(-4, -2));
  if (kind == "pair") {
    add_string({0, 0, 0}, {1, 0, 0}, 2 + below(6), strain);
    add_string({0, 1, 0}, {1, 1.3, 0}, 2 + below(6), 0.3 * strain);
  }
  if (kind == "loose") {  // without tension there is no linear force across
    add_string({0, 0, 0}, {1, 0, 0}, 2 + below(6), 0);
  }
  if (kind == "hanging") {
    try {
      scene_ = settled(scene_, "the scene");
    } catch (const InvalidInput&) {
      return false;
    }
  }
  if (is(0.2)) scene_.air_damping = power(-2, 0);
  size = power(-8, -2.5);
  const bool is_plucked = is(0.6), is_smooth = is(0.3);
  // In one direction some motions stay in a plane.
  const Vector one = direction();
  const double w = std::sqrt(1000 / 0.02);
  for (Node& node : scene_.nodes) {
    if (node.pinned) continue;
    const double shape = std::sin(std::numbers::pi * node.position[0]);
    const Vector u = size * (is_smooth ? Vector(shape * one) : vector(1));
    if (is_plucked) node.position += u;
    if (!is_plucked || is(0.5)) node.velocity = w * (is_smooth ? 0.1 * u : size * vector(0.3));
  }
  const Model model(scene_);
  if (model.system().size() == 0) return false;
  const double fastest = frequency_bound(model.system(), model.initial().q);
  scene_.until = 2 * power(3, 4.4) / fastest;
  return true;
}

inline void SmallScenes::add_string(const Vector& from, const Vector& to, std::size_t nodes,
                                    double strain) {
  std::size_t last = add(from, true);
  for (std::size_t k = 1; k <= nodes; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(nodes + 1);
    const std::size_t node = add(from + part * (to - from));
    join(last, node, strain);
    last = node;
  }
  join(last, add(to, true), strain);
}

// A square net with pinned sides.
inline void SmallScenes::add_net(std::size_t rows, double strain) {
  const double h = 1 / static_cast<double>(rows - 1);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < rows; ++c) {
      const bool is_side = r == 0 || c == 0 || r + 1 == rows || c + 1 == rows;
      const std::size_t node =
          add({h * static_cast<double>(c), h * static_cast<double>(r), 0}, is_side);
      if (c > 0) join(node - 1, node, strain);
      if (r > 0) join(node - rows, node, strain);
    }
  }
}

// A braced tower of squares, or of cubes in space, on pins.
inline void SmallScenes::add_lattice(double strain) {
  const std::size_t floors = 2 + below(4);
  const bool is_flat = scene_.dimension == 2;
  const std::size_t corners = is_flat ? 2 : 4;
  const std::array<Vector, 4> at = {Vector(0, 0, 0), Vector(0, 0.3, 0), Vector(0, 0.3, 0.3),
                                    Vector(0, 0, 0.3)};
  for (std::size_t f = 0; f < floors; ++f) {
    const std::size_t first = scene_.nodes.size();
    for (std::size_t c = 0; c < corners; ++c) {
      const Vector shift = vector(0.02);
      add(at[c] + Vector(0.25 * static_cast<double>(f), 0, 0) + shift, f == 0);
    }
    for (std::size_t c = 0; c < corners; ++c) {
      if (f > 0) {
        for (std::size_t d = 0; d < corners; ++d) join(first - corners + d, first + c, strain);
        for (std::size_t d = 0; d < c; ++d) join(first + d, first + c, strain);
      }
    }
  }
}

// A net that hangs by two corners and by its own weight.
inline void SmallScenes::add_hanging() {
  const std::size_t columns = 2 + below(3), rows = 2 + below(3);
  scene_.gravity[1] = -9.81;
  const double h = 0.3;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const bool is_pin = r == 0 && (c == 0 || c + 1 == columns);
      const Vector at(h * static_cast<double>(c), -h * static_cast<double>(r), 0);
      const std::size_t node = add(at + vector(0.01), is_pin);
      if (c > 0) join(node - 1, node, 0, 300);
      if (r > 0) join(node - columns, node, 0, 300);
      if (r > 0 && c > 0) join(node - columns - 1, node, 0, 300);
    }
  }
}

}  // namespace tests
}  // namespace qddot
