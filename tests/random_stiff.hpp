#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "qddot/scene/scene.hpp"
#include "tests/scene_draws.hpp"

namespace qddot {
inline namespace tests {

// A small scene with some very stiff springs, made by chance. The same seed gives the same scene
// everywhere.
struct StiffScene {
  Scene scene;
  std::string kind;
  double between = 0;  // the stiff springs have more stiffness than this [N/m], the others less
  double ratio = 0;    // of the stiffnesses
};

// Makes scenes whose stiff springs start at rest lengths that no velocity changes, so that rods
// could be in their place; or, if they are to vibrate, with a stretch and with dashpots.
class StiffScenes : SceneDraws {
 public:
  explicit StiffScenes(std::uint64_t seed, bool vibrate = false)
      : SceneDraws(seed), vibrate_(vibrate) {}

  static const std::vector<std::string>& kinds() {
    static const std::vector<std::string> all = {"cloth", "chain", "tree", "net", "ring", "spin"};
    return all;
  }

  StiffScene draw() {
    const std::string kind = kinds()[below(kinds().size())];
    spacing_ = power(-1.3, 0);
    typical_mass_ = power(-2, 0.5);
    is_uneven_ = is(0.3);
    scene_.dimension = 2 + static_cast<int>(below(2));
    if (kind == "chain" && is(0.08)) scene_.dimension = 1;
    add_kind(kind);
    const bool is_held =
        std::ranges::any_of(scene_.nodes, [](const Node& node) { return node.pinned; });
    set_gravity(is_held);
    const double ratio = power(2, 7);
    const double between = set_laws(ratio);
    if (!is_held || is(0.5)) set_velocities(!is_held);
    damp_some(ratio);
    if (vibrate_) set_off(between);
    const double times = uniform(0.2, 3);
    scene_.until = times * std::sqrt(extent() / acceleration_);
    return {scene_, kind, between, ratio};
  }

 private:
  std::size_t add(const Vector& position) {
    const double mass = typical_mass_ * (is_uneven_ ? power(-1, 1) : power(-0.15, 0.15));
    scene_.nodes.push_back({.position = position, .mass = mass});
    return scene_.nodes.size() - 1;
  }
  // `is_stiff` is kept in Spring::stiff until the laws are set.
  void join(std::size_t i, std::size_t j, bool is_stiff) {
    scene_.springs.push_back({.nodes = {i, j}, .law = {}, .stiff = is_stiff});
  }
  double extent() const {
    double largest = spacing_;
    for (const Node& a : scene_.nodes) {
      for (const Node& b : scene_.nodes)
        largest = std::max(largest, (a.position - b.position).norm());
    }
    return largest;
  }

  void add_kind(const std::string& kind);
  void add_grid(std::size_t rows, std::size_t columns, bool is_braced);
  void add_cloth();
  void add_chain(bool is_free);
  void add_tree(bool is_free);
  void add_net();
  void add_ring(bool is_free);
  void choose_forest(double share);
  void pin_some(std::size_t most);
  void set_gravity(bool is_held);
  double set_laws(double ratio);
  void set_velocities(bool spins);
  void damp_some(double ratio);
  void set_off(double between);

  bool vibrate_;
  double spacing_ = 1, typical_mass_ = 1;
  double acceleration_ = 9.81;  // a typical one [m/s^2]
  double soft_ = 1;             // a typical stiffness of the others [N/m]
  bool is_uneven_ = false;
};

inline void StiffScenes::add_kind(const std::string& kind) {
  if (kind == "cloth") add_cloth();
  if (kind == "chain") add_chain(false);
  if (kind == "tree") add_tree(is(0.2));
  if (kind == "net") add_net();
  if (kind == "ring") add_ring(is(0.2));
  if (kind == "spin") {
    const std::size_t form = below(3);
    if (form == 0) add_chain(true);
    if (form == 1) add_tree(true);
    if (form == 2) add_ring(true);
  }
}

// Nodes in rows, each of the first `rows` times `columns` numbers, with springs between neighbours.
inline void StiffScenes::add_grid(std::size_t rows, std::size_t columns, bool is_braced) {
  const double off = is(0.3) ? 0 : spacing_ * power(-1.7, -0.7);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const Vector at(static_cast<double>(c), -static_cast<double>(r), 0);
      const Vector shift = vector(off);
      const std::size_t node = add(spacing_ * at + shift);
      if (c > 0) join(node - 1, node, false);
      if (r > 0) join(node - columns, node, false);
      if (is_braced && r > 0 && c > 0) join(node - columns - 1, node, false);
      if (is_braced && r > 0 && c > 0) join(node - columns, node - 1, false);
    }
  }
}

// Pins up to so many nodes, at least one; a node may be chosen twice.
inline void StiffScenes::pin_some(std::size_t most) {
  const std::size_t count = 1 + below(most);
  for (std::size_t k = 0; k < count; ++k) scene_.nodes[below(scene_.nodes.size())].pinned = true;
}

// A cloth with a stiff hem, or a part of it, or stiff rows.
inline void StiffScenes::add_cloth() {
  const std::size_t rows = 3 + below(4);
  const std::size_t columns = 3 + below(4);
  const bool is_braced = is(0.5);
  add_grid(rows, columns, is_braced);
  const std::size_t choice = below(4);
  const std::size_t row = below(rows);
  for (Spring& spring : scene_.springs) {
    const auto [i, j] = spring.nodes;
    const bool is_level = i / columns == j / columns, is_upright = i % columns == j % columns;
    const bool is_rim_row = i / columns == 0 || i / columns == rows - 1;
    const bool is_rim_column = i % columns == 0 || i % columns == columns - 1;
    const bool is_hem = (is_level && is_rim_row) || (is_upright && is_rim_column);
    if (choice == 0) spring.stiff = is_hem;
    if (choice == 1) spring.stiff = is_level;
    if (choice == 2) spring.stiff = is_level && i / columns == row;
    if (choice == 3) spring.stiff = is_upright && is_rim_column;
  }
  pin_some(3);
}

// A folded row of springs, of which a part in a row is stiff, or some here and there.
inline void StiffScenes::add_chain(bool is_free) {
  const std::size_t links = 3 + below(is_free ? 10 : 28);
  const double fold = is(0.3) ? 0.01 : uniform(0.05, 1);
  const Vector ahead = direction();
  add(Vector::Zero());
  for (std::size_t k = 0; k < links; ++k) {
    const double length = spacing_ * uniform(0.7, 1.3);
    const Vector aside = direction();
    const Vector step = scene_.dimension == 1 ? ahead : (ahead + fold * aside).normalized();
    const std::size_t node = add(scene_.nodes.back().position + length * step);
    join(node - 1, node, false);
  }
  const std::size_t part = std::max<std::size_t>(1, links / (2 + below(2)));
  const std::size_t first = below(links - part + 1);
  const bool is_scattered = is(0.3);
  const std::size_t few = 1 + below(3);
  for (std::size_t k = 0; k < part && !is_scattered; ++k) scene_.springs[first + k].stiff = true;
  for (std::size_t k = 0; k < few && is_scattered; ++k) scene_.springs[below(links)].stiff = true;
  if (is_free) return;
  scene_.nodes.front().pinned = true;
  scene_.nodes.back().pinned = is(0.35);
}

// A tree of stiff springs, with others across.
inline void StiffScenes::add_tree(bool is_free) {
  const std::size_t links = 2 + below(11);
  add(Vector::Zero());
  for (std::size_t k = 0; k < links; ++k) {
    const std::size_t from = below(scene_.nodes.size());
    const double length = spacing_ * uniform(0.5, 1.5);
    const Vector step = direction();
    const std::size_t node = add(scene_.nodes[from].position + length * step);
    join(from, node, true);
  }
  const std::size_t across = 1 + below(links);
  for (std::size_t k = 0; k < across; ++k) {
    const std::size_t i = below(scene_.nodes.size());
    const std::size_t j = below(scene_.nodes.size());
    if (i == j) continue;
    const double apart = (scene_.nodes[i].position - scene_.nodes[j].position).norm();
    if (apart > 0.2 * spacing_) join(i, j, false);
  }
  scene_.nodes.front().pinned = !is_free;
}

// Makes springs stiff that close no ring; each of those by chance.
inline void StiffScenes::choose_forest(double share) {
  std::vector<std::size_t> tree(scene_.nodes.size()), order(scene_.springs.size());
  std::iota(tree.begin(), tree.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[below(k)]);
  for (const std::size_t k : order) {
    const auto [i, j] = scene_.springs[k].nodes;
    const std::size_t from = tree[i], to = tree[j];
    if (!is(share) || from == to) continue;
    scene_.springs[k].stiff = true;
    std::ranges::replace(tree, from, to);
  }
}

// A grid, or nodes in space with springs to near ones, in which a forest of springs is stiff.
inline void StiffScenes::add_net() {
  if (is(0.5)) {
    const std::size_t rows = 2 + below(4);
    const std::size_t columns = 3 + below(3);
    add_grid(rows, columns, true);
  } else {
    const std::size_t count = 4 + below(14);
    while (scene_.nodes.size() < count) {
      const Vector at = vector(1.2 * spacing_ * std::cbrt(static_cast<double>(count)));
      const auto is_near = [&](const Node& node) {
        return (node.position - at).norm() < 0.4 * spacing_;
      };
      if (std::ranges::none_of(scene_.nodes, is_near)) add(at);
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::size_t> others(i);
      std::iota(others.begin(), others.end(), 0);
      const auto apart = [&](std::size_t j) {
        return (scene_.nodes[i].position - scene_.nodes[j].position).norm();
      };
      std::ranges::sort(others, {}, apart);
      for (std::size_t k = 0; k < std::min<std::size_t>(i, 3); ++k) join(others[k], i, false);
    }
  }
  const double share = uniform(0.1, 0.7);
  choose_forest(share);
  pin_some(3);
}

// A ring of stiff springs around one or more cells of a braced net.
inline void StiffScenes::add_ring(bool is_free) {
  const std::size_t rows = 3 + below(3);
  const std::size_t columns = 3 + below(3);
  const std::size_t left = below(columns - 1);
  const std::size_t right = left + 1 + below(columns - 1 - left);
  const std::size_t top = below(rows - 1);
  const std::size_t bottom = top + 1 + below(rows - 1 - top);
  add_grid(rows, columns, is(0.7));
  for (Spring& spring : scene_.springs) {
    const auto [i, j] = spring.nodes;
    const std::size_t row = i / columns, column = i % columns;
    const bool is_level = row == j / columns, is_upright = column == j % columns;
    const bool is_wide = column >= left && j % columns <= right;
    const bool is_high = row >= top && j / columns <= bottom;
    spring.stiff = (is_level && is_wide && (row == top || row == bottom)) ||
                   (is_upright && is_high && (column == left || column == right));
  }
  if (!is_free) pin_some(2);
}

inline void StiffScenes::set_gravity(bool is_held) {
  if (is_held || is(0.3)) scene_.gravity[scene_.dimension > 1 ? 1 : 0] = -9.81;
  if (is(0.15)) scene_.gravity = vector(8);
  if (scene_.dimension == 3 && is(0.2)) scene_.gravity = Vector(0, 0, -9.81);
  if (scene_.gravity.norm() > 1) acceleration_ = scene_.gravity.norm();
}

// Sets rest lengths and stiffnesses such that soft springs stretch by a few or many percent.
// Returns a stiffness between those of both sorts.
inline double StiffScenes::set_laws(double ratio) {
  const double sag = power(-1.2, -0.1);
  const double load = std::sqrt(static_cast<double>(scene_.nodes.size()));
  soft_ = typical_mass_ * acceleration_ * load / (spacing_ * sag);
  const bool is_stretched = is(0.4);
  for (Spring& spring : scene_.springs) {
    const auto [i, j] = spring.nodes;
    const double length = (scene_.nodes[j].position - scene_.nodes[i].position).norm();
    const double uneven = spring.stiff ? uniform(0.8, 1.4) : uniform(0.6, 1.6);
    const double stretch = uniform(0.9, 1.1);
    spring.law.stiffness = uneven * soft_ * (spring.stiff ? ratio : 1);
    spring.law.rest_length = length * (is_stretched && !spring.stiff ? stretch : 1);
  }
  return std::sqrt(ratio) * soft_;
}

// Random velocities, and those of a turn, laid on the lengths of all stiff springs.
inline void StiffScenes::set_velocities(bool spins) {
  const double size = std::sqrt(acceleration_ * extent());
  const double part = spins ? uniform(0, 0.3) : uniform(0.05, 0.6);
  const double turn = spins ? size / extent() * uniform(0.5, 4) : 0;
  const Vector axis = scene_.dimension == 3 ? direction() : Vector(0, 0, 1);
  std::vector<Spring> rods;
  for (const Spring& spring : scene_.springs) {
    const auto [i, j] = spring.nodes;
    if (spring.stiff && !(scene_.nodes[i].pinned && scene_.nodes[j].pinned)) rods.push_back(spring);
  }
  const Eigen::Index n = 3 * std::ssize(scene_.nodes);
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(std::ssize(rods), n);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(n), per_mass = v;
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    const Vector own = vector(part * size);
    if (scene_.nodes[i].pinned) continue;
    const auto at = static_cast<Eigen::Index>(3 * i);
    v.segment<3>(at) = own;
    if (scene_.dimension > 1) v.segment<3>(at) += turn * axis.cross(scene_.nodes[i].position);
    per_mass.segment<3>(at).setConstant(1 / scene_.nodes[i].mass);
  }
  for (std::size_t k = 0; k < rods.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const auto [i, j] = rods[k].nodes;
    const Vector d = (scene_.nodes[j].position - scene_.nodes[i].position).normalized();
    g.row(row).segment<3>(static_cast<Eigen::Index>(3 * i)) -= d.transpose();
    g.row(row).segment<3>(static_cast<Eigen::Index>(3 * j)) += d.transpose();
  }
  if (!rods.empty()) {  // pins may hold all stiff springs
    const Eigen::MatrixXd a = g * per_mass.asDiagonal() * g.transpose();
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors(a);
    for (int times = 0; times < 3; ++times) {
      const Eigen::VectorXd pull = factors.solve(g * v);
      v -= per_mass.asDiagonal() * (g.transpose() * pull);
    }
  }
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i)
    scene_.nodes[i].velocity = v.segment<3>(static_cast<Eigen::Index>(3 * i));
}

// A stretch, velocities beside in some scenes, and dashpots of one ratio on all stiff springs.
inline void StiffScenes::set_off(double between) {
  const double strain = power(-6, -2.3), zeta = power(-2, 0.3);
  const bool is_pushed = is(0.3);
  for (Spring& spring : scene_.springs) {
    SpringLaw& law = spring.law;
    if (!(law.stiffness > between)) continue;
    law.rest_length *= 1 + strain * uniform(-1, 1);
    law.damping = 2 * zeta * std::sqrt(law.stiffness * typical_mass_);
    Node& node = scene_.nodes[spring.nodes[1]];
    const double w = std::sqrt(law.stiffness / typical_mass_);
    if (is_pushed && !node.pinned) node.velocity += vector(strain * law.rest_length * w);
  }
}

// Air in some scenes; dashpots on soft springs or, by one time for all, also on the stiff ones.
inline void StiffScenes::damp_some(double ratio) {
  if (is(0.15)) scene_.air_damping = uniform(0.1, 1.5);
  const double soft_time = std::sqrt(typical_mass_ / soft_);
  const bool all = is(0.1), soft_alone = is(0.15);
  const double part = power(-2, -0.3);
  if (all) damp_springs(part * soft_time / std::sqrt(ratio), scene_);
  for (Spring& spring : scene_.springs) {
    if (soft_alone && !spring.stiff) spring.law.damping = part * soft_time * spring.law.stiffness;
  }
  for (Spring& spring : scene_.springs) spring.stiff = false;
}

}  // namespace tests
}  // namespace qddot
