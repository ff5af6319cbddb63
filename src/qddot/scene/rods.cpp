#include "qddot/scene/rods.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot {
namespace {

// How far a length or a speed may be off by rounding, in units of the scene's.
constexpr double rounding = 1e-12;
// A pivot of A = G M^-1 G', over the diagonal, is the squared sine of the angle between a rod's
// gradient and those of other rods. Below this, rounding decides about the rest: A's own rounding
// is about 1e-16 times the number of rods.
constexpr double least_pivot = 1e-10;

// A rod with its ends at the start.
struct Drawn {
  const Spring* spring;
  Eigen::Vector3d d, w;  // from end to end [m], and their rates [m/s]
};

std::string name(const Spring& rod) {
  return fmt::format("the rod between nodes {} and {}", rod.nodes[0], rod.nodes[1]);
}

[[noreturn]] void refuse(const std::string& source, const Spring& rod, const std::string& why) {
  throw InvalidInput(fmt::format("{}: {} {}", source, name(rod), why));
}

// A node's place and velocity at t = 0.
Node at_start(const Scene& scene, std::size_t i) {
  Node node = scene.nodes[i];
  if (!node.pinned) return node;
  node.velocity.setZero();
  if (node.curve < 0) return node;
  const TimeCurve& curve = scene.curves[static_cast<std::size_t>(node.curve)];
  node.position += curve.at(0);
  node.velocity = curve.rate(0);
  return node;
}

// Row k of G is -n for the first node of rod k and n for the second; pinned nodes have no columns.
Eigen::SparseMatrix<double> scaled_matrix(const Scene& scene, const std::vector<Drawn>& rods) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < rods.size(); ++k) {
    const auto [i, j] = rods[k].spring->nodes;
    const Eigen::Vector3d n = rods[k].d.normalized();
    double square = 0;
    for (const std::size_t node : {i, j}) {
      if (!scene.nodes[node].pinned) square += 1 / scene.nodes[node].mass;
    }
    for (const std::size_t node : {i, j}) {
      if (scene.nodes[node].pinned) continue;
      const double size = (node == i ? -1 : 1) / std::sqrt(scene.nodes[node].mass * square);
      for (int a = 0; a < scene.dimension; ++a) {
        entries.emplace_back(static_cast<int>(k), static_cast<int>(3 * node) + a, size * n[a]);
      }
    }
  }
  Eigen::SparseMatrix<double> g(std::ssize(rods), 3 * std::ssize(scene.nodes));
  g.setFromTriplets(entries.begin(), entries.end());
  return g * g.transpose();
}

void require_independent(const Scene& scene, const std::vector<Drawn>& rods,
                         const std::string& source) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(scaled_matrix(scene, rods));
  const Eigen::VectorXd pivots = factors.vectorD();
  Eigen::Index place = 0;
  // A pivot of zero ends the factorisation; those behind it are not computed.
  while (place < pivots.size() && pivots[place] > least_pivot) ++place;
  if (place == pivots.size()) return;
  const Eigen::Index k = factors.permutationPinv().indices()[place];
  refuse(source, *rods[static_cast<std::size_t>(k)].spring,
         "is one too many: others already hold its length, or a row of them is taut between two "
         "pins; take a spring for it");
}

}  // namespace

bool has_rods(const Scene& scene) {
  return std::ranges::any_of(scene.springs, [](const Spring& spring) { return spring.law.rigid; });
}

void make_rods_above(double stiffness, Scene& scene) {
  for (Spring& spring : scene.springs) {
    const auto [i, j] = spring.nodes;
    if (scene.nodes[i].pinned && scene.nodes[j].pinned) continue;
    if (spring.law.stiffness > stiffness)
      spring.law = {.rest_length = spring.law.rest_length, .rigid = true};
  }
}

std::vector<double> stiffness_gaps(const Scene& scene, double ratio) {
  std::vector<double> all;
  for (const Spring& spring : scene.springs) {
    if (spring.law.stiffness > 0) all.push_back(spring.law.stiffness);
  }
  // Most scenes have none, and need no sorting.
  if (all.empty()) return {};
  if (const auto [least, most] = std::ranges::minmax(all); most < ratio * least) return {};
  std::ranges::sort(all, std::ranges::greater());
  std::vector<double> gaps;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i - 1] >= ratio * all[i]) gaps.push_back(all[i]);
  }
  return gaps;
}

void validate_rods(const Scene& scene, const std::string& source) {
  std::vector<Drawn> rods;
  double size = 0, speed = 0;
  for (const Spring& spring : scene.springs) {
    if (!spring.law.rigid) continue;
    const auto [i, j] = spring.nodes;
    if (scene.nodes[i].pinned && scene.nodes[j].pinned)
      refuse(source, spring, "joins two pinned nodes; allowed are rods on a node that moves");
    for (const std::size_t node : {i, j}) {
      if (!scene.nodes[node].pinned && scene.nodes[node].mass == 0)
        refuse(source, spring,
               fmt::format("has node {} without mass; allowed are masses above 0 "
                           "and pins",
                           node));
    }
    if (!(spring.law.rest_length > 0) || !std::isfinite(spring.law.rest_length))
      refuse(
          source, spring,
          fmt::format("has the length {} m; allowed are lengths above 0", spring.law.rest_length));
    const Node a = at_start(scene, i), b = at_start(scene, j);
    rods.push_back({&spring, b.position - a.position, b.velocity - a.velocity});
    for (const Node& node : {a, b}) {
      size = std::max(size, node.position.lpNorm<Eigen::Infinity>());
      speed = std::max(speed, node.velocity.lpNorm<Eigen::Infinity>());
    }
    size = std::max(size, spring.law.rest_length);
  }
  if (rods.empty()) return;
  if (scene.starts_at_equilibrium)
    throw InvalidInput(fmt::format(
        "{}: start: \"equilibrium\" is not found for scenes with rods; allowed is \"drawn\"",
        source));
  for (const auto& [spring, d, w] : rods) {
    const double length = spring->law.rest_length, l = d.norm(), rate = d.dot(w) / l;
    if (!(std::abs(l - length) <= rounding * size))
      refuse(source, *spring,
             fmt::format("is {} m long, but its ends are {} m apart at the start; "
                         "allowed is that length, and none given takes it",
                         length, l));
    if (!(std::abs(rate) <= rounding * speed))
      refuse(source, *spring,
             fmt::format("would change its length by {:.6g} m/s at the start; allowed are "
                         "velocities that keep it",
                         rate));
  }
  require_independent(scene, rods, source);
}

}  // namespace qddot
