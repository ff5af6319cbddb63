#pragma once

#include <bit>
#include <cstdint>
#include <string>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace tests {

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return same_bits(a[0], b[0]) && same_bits(a[1], b[1]) && same_bits(a[2], b[2]);
}

// The first field in which two scenes differ by any bit; empty where they are the same.
inline std::string first_difference(const Scene& a, const Scene& b) {
  if (a.name != b.name) return "name";
  if (a.dimension != b.dimension) return "dimension";
  if (!same_bits(a.gravity, b.gravity)) return "gravity";
  if (a.until.has_value() != b.until.has_value()) return "until";
  if (a.until && !same_bits(*a.until, *b.until)) return "until";
  if (a.stiff_above.has_value() != b.stiff_above.has_value()) return "stiff_above";
  if (a.stiff_above && !same_bits(*a.stiff_above, *b.stiff_above)) return "stiff_above";
  if (!same_bits(a.air_damping, b.air_damping)) return "air_damping";
  if (a.starts_at_equilibrium != b.starts_at_equilibrium) return "start";
  if (a.nodes.size() != b.nodes.size()) return "nodes";
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const Node &m = a.nodes[i], &n = b.nodes[i];
    if (!same_bits(m.position, n.position)) return "position";
    if (!same_bits(m.velocity, n.velocity)) return "velocity";
    if (!same_bits(m.mass, n.mass)) return "mass";
    if (m.pinned != n.pinned) return "pinned";
    if (!same_bits(m.load, n.load)) return "load";
  }
  if (a.springs.size() != b.springs.size()) return "springs";
  for (std::size_t i = 0; i < a.springs.size(); ++i) {
    const Spring &s = a.springs[i], &t = b.springs[i];
    if (s.nodes != t.nodes) return "nodes of a spring";
    if (!same_bits(s.law.stiffness, t.law.stiffness)) return "stiffness";
    if (!same_bits(s.law.rest_length, t.law.rest_length)) return "rest_length";
    if (!same_bits(s.law.quartic, t.law.quartic)) return "quartic";
    if (!same_bits(s.law.damping, t.law.damping)) return "damping";
  }
  return content_hash(a) == content_hash(b) ? "" : "hash";
}

}  // namespace tests
}  // namespace qddot
