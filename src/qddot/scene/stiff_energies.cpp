#include "qddot/scene/stiff_energies.hpp"

namespace qddot {
namespace {

// [kg]
double reduced_mass(const Node& a, const Node& b) {
  if (a.pinned) return b.mass;  // if both are, nothing moves
  if (b.pinned) return a.mass;
  return a.mass > 0 && b.mass > 0 ? a.mass * b.mass / (a.mass + b.mass) : 0;
}

double oscillatory_energy(const SpringLaw& law, const Node& a, const Node& b) {
  const Eigen::Vector3d d = b.position - a.position, v = b.velocity - a.velocity;
  const double l = d.norm();
  const double along = l > 0 ? d.dot(v) / l : v.norm();
  return 0.5 * reduced_mass(a, b) * along * along + law.energy(l);
}

}  // namespace

std::vector<std::size_t> stiff_springs(const Scene& scene) {
  std::vector<std::size_t> stiff;
  for (std::size_t e = 0; e < scene.springs.size(); ++e) {
    if (is_stiff(scene.springs[e].law, scene.stiff_above)) stiff.push_back(e);
  }
  return stiff;
}

Vec stiff_energies(const Scene& scene, const std::vector<Node>& nodes) {
  const auto stiff = stiff_springs(scene);
  Vec energies(static_cast<Index>(stiff.size()));
  for (std::size_t i = 0; i < stiff.size(); ++i) {
    const Spring& spring = scene.springs[stiff[i]];
    const auto [a, b] = spring.nodes;
    energies[static_cast<Index>(i)] = oscillatory_energy(spring.law, nodes[a], nodes[b]);
  }
  return energies;
}

}  // namespace qddot
