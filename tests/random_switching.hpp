#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/independent_switching.hpp"
#include "tests/scene_draws.hpp"

namespace qddot {
inline namespace tests {

// A small valid scene made by chance, whose springs go slack or break, and what is special about
// it. The same seed gives the same scene everywhere.
struct SwitchingScene {
  Scene scene;
  std::string kind;
};

// Makes scenes of metres, kilograms and some hundred N/m.
class SwitchingScenes : SceneDraws {
 public:
  explicit SwitchingScenes(std::uint64_t seed) : SceneDraws(seed) {}

  // One of seven kinds, with dashpots, air, cubic and quartic terms on some.
  SwitchingScene draw() {
    static const std::vector<std::string> kinds = {"bouncing",  "hanging", "random",        "mixed",
                                                   "symmetric", "free",    "at_rest_length"};
    const std::string kind = kinds[below(kinds.size())];
    scene_ = {};
    scene_.dimension =
        kind == "hanging" || kind == "symmetric" ? 2 + int(below(2)) : 1 + int(below(3));
    scene_.until = uniform(0.4, 1.2);
    cable_share_ = kind == "mixed" ? uniform(0.3, 0.8) : 1;
    if (kind == "bouncing") add_bouncing(1 + below(2), 0.25);
    if (kind == "at_rest_length") add_bouncing(1, 0);
    if (kind == "hanging") add_grid(1 + below(4), 2 + below(2));
    if (kind == "random" || kind == "mixed") add_network(2 + below(8), true);
    if (kind == "free") add_network(2 + below(5), false);
    if (kind == "symmetric") add_symmetric();
    if (kind != "symmetric" && kind != "at_rest_length") {
      stiffen_some();
      damp_some();
    }
    if (is(0.15)) scene_.air_damping = uniform(0.1, 2);
    return {scene_, kind};
  }

  // The same, with thresholds at which a few springs break. They are shares of the largest strains
  // of the motion without breaking, so that most are passed.
  SwitchingScene draw_breaking() {
    SwitchingScene drawn = draw();
    // Thresholds need no digits.
    SwitchingMotion whole(drawn.scene, 1e-9L);
    if (!whole.advance(*drawn.scene.until)) return drawn;
    const double share = uniform(0.1, 0.6);
    // Images break together if they have one threshold.
    const bool are_alike = drawn.kind == "symmetric";
    const double factor = uniform(0.4, 1.05);
    double most = 0;
    for (std::size_t e = 0; e < drawn.scene.springs.size(); ++e)
      most = std::max(most, static_cast<double>(whole.most_strain(e)));
    for (std::size_t e = 0; e < drawn.scene.springs.size(); ++e) {
      Spring& spring = drawn.scene.springs[e];
      const double own = static_cast<double>(whole.most_strain(e));
      const auto [i, j] = spring.nodes;
      const bool rests = drawn.scene.nodes[i].pinned && drawn.scene.nodes[j].pinned;
      if (!(own > 1e-3) || rests) continue;
      if (are_alike) {
        spring.law.breaks_at = factor * most;
      } else if (is(share)) {
        spring.law.breaks_at = uniform(0.3, 1.05) * own;
      }
    }
    drawn.kind = "breaking " + drawn.kind;
    return drawn;
  }

 private:
  double stiffness() { return std::pow(10, uniform(1.7, 3.2)); }
  int down() const { return scene_.dimension == 1 ? 0 : 1; }

  std::size_t add(const Vector& position, bool pinned, double speed) {
    Node node{.position = position, .mass = std::pow(10, uniform(-0.7, 0.3)), .pinned = pinned};
    if (!pinned) node.velocity = vector(speed);
    scene_.nodes.push_back(node);
    return scene_.nodes.size() - 1;
  }
  // A cable, or a plain spring by chance, whose rest length is `ratio` times its length.
  void join(std::size_t i, std::size_t j, double ratio) {
    const double l = (scene_.nodes[j].position - scene_.nodes[i].position).norm();
    if (l == 0) return;
    SpringLaw law{.stiffness = stiffness(), .rest_length = ratio * l};
    law.pulls_only = is(cable_share_);
    if (!law.pulls_only && is(0.2)) law.rest_length = 0;
    scene_.springs.push_back({{i, j}, law});
  }

  // Masses on one or several cables each, and between one another, which start slack or taut.
  void add_bouncing(std::size_t masses, double slack) {
    scene_.gravity[down()] = -9.81;
    for (std::size_t k = 0; k < masses; ++k) {
      const double side = static_cast<double>(k);
      const Vector at = scene_.dimension == 1 ? Vector(-side, 0, 0) : Vector(2 * side, 0, 0);
      const std::size_t mass = add(at + vector(0.2), false, slack > 0 ? 2 : 0);
      const std::size_t cables = slack > 0 ? 1 + below(3) : 1;
      for (std::size_t c = 0; c < cables; ++c) {
        Vector pin = scene_.nodes[mass].position + vector(0.7);
        pin[down()] = uniform(0.5, 1.2);
        if (slack == 0)
          pin = scene_.nodes[mass].position + uniform(0.5, 1.2) * Vector::Unit(down());
        join(add(pin, true, 0), mass, slack > 0 ? uniform(0.9, 1 + 2 * slack) : 1);
      }
      if (k > 0 && is(0.5)) join(mass, 0, uniform(0.9, 1.1));
    }
  }

  // A net that hangs on the pins of its first row, slack by up to a tenth.
  void add_grid(std::size_t rows, std::size_t columns) {
    scene_.gravity[1] = -9.81;
    const std::size_t first = scene_.nodes.size();
    const double loose = uniform(0.97, 1.1);
    for (std::size_t r = 0; r <= rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        const Vector at(0.5 * static_cast<double>(c), -0.5 * static_cast<double>(r), 0);
        const std::size_t node = add(at + vector(0.05), r == 0, 1);
        if (r > 0) join(node - columns, node, loose * uniform(0.95, 1.05));
        if (r > 0 && c > 0) join(node - 1, node, loose * uniform(0.95, 1.05));
        if (r > 0 && c > 0 && is(0.3)) join(first + (r - 1) * columns + c - 1, node, loose);
      }
    }
  }

  // Nodes by chance, each joined to one before it and some to others; some are pins.
  void add_network(std::size_t masses, bool has_pins) {
    if (has_pins && is(0.7)) scene_.gravity[down()] = -9.81;
    if (!has_pins && is(0.3)) scene_.gravity = vector(9);
    const double size = 0.4 * std::pow(static_cast<double>(masses + 2), 1.0 / scene_.dimension);
    const std::size_t pins = has_pins ? 1 + below(3) : 0;
    for (std::size_t k = 0; k < masses + pins; ++k) {
      const bool pinned = k < pins;
      const Vector on_line(0.8 * static_cast<double>(k) + uniform(-0.2, 0.2), 0, 0);
      const std::size_t node =
          add(scene_.dimension == 1 ? on_line : vector(size), pinned, pinned ? 0 : 1.5);
      if (k == 0) continue;
      join(scene_.dimension == 1 ? node - 1 : below(node), node, uniform(0.85, 1.15));
      for (int extra = 0; extra < 2; ++extra) {
        const std::size_t other = below(node);
        if (!(pinned && scene_.nodes[other].pinned)) join(other, node, uniform(0.85, 1.15));
      }
    }
  }

  // A star or a grid between pins with mirror planes: springs and masses are alike, so that many
  // go slack at one moment.
  void add_symmetric() {
    const double k = stiffness(), ratio = uniform(0.9, 1.08), speed = uniform(0.5, 3);
    const int planes = scene_.dimension;
    const auto line = [&](std::size_t i, std::size_t j) {
      join(i, j, ratio);
      scene_.springs.back().law.stiffness = k;
    };
    // Corners of a square or cube, joined to pins outwards and to a mass in the middle.
    const std::size_t middle = add(Vector::Zero(), false, 0);
    scene_.nodes[middle].mass = 1;
    for (unsigned corner = 0; corner < (1U << planes); ++corner) {
      Vector at = Vector::Zero();
      for (int d = 0; d < planes; ++d) at[d] = (corner >> d) & 1U ? 0.5 : -0.5;
      const std::size_t mass = add(at, false, 0);
      scene_.nodes[mass].mass = 0.5;
      scene_.nodes[mass].velocity = speed * at;
      line(mass, add(2 * at, true, 0));
      line(middle, mass);
    }
    if (is(0.5)) {
      scene_.gravity[1] = -9.81;
    }
  }

  // Cubic and quartic terms that leave each law monotone over the lengths of the motion.
  void stiffen_some() {
    const double share = is(0.4) ? uniform(0.2, 1) : 0;
    for (Spring& spring : scene_.springs) {
      SpringLaw& law = spring.law;
      if (law.rest_length == 0 || !is(share)) continue;
      // The slope k + 2 b s stays above k/3 where |s| is below l0.
      law.cubic = uniform(-1, 1) * law.stiffness / (3 * law.rest_length);
      if (is(0.3)) law.quartic = law.stiffness * uniform(0, 2);
    }
  }

  void damp_some() {
    if (!is(0.35)) return;
    const double share = uniform(0.2, 1), ratio = std::pow(10, uniform(-2, -0.5));
    for (Spring& spring : scene_.springs) {
      if (is(share)) spring.law.damping = ratio * std::sqrt(spring.law.stiffness);
    }
  }

  double cable_share_ = 1;
};

}  // namespace tests
}  // namespace qddot
