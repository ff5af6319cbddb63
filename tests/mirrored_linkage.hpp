#pragma once

#include <cstdint>
#include <optional>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/rods.hpp"
#include "tests/random_linkage.hpp"

namespace qddot {
inline namespace tests {

// A random linkage beside its image in a plane normal to x. Rods or springs join some nodes with
// their images. Nothing if rods are redundant or hold energy so.
inline std::optional<Scene> mirrored_linkage(std::uint64_t seed) {
  const LinkageScene drawn = LinkageScenes(seed).draw();
  Scene scene = drawn.scene;
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  scene.gravity[0] = 0;
  double left = 0;
  for (const Node& node : scene.nodes) left = std::min(left, node.position[0]);
  const std::size_t count = scene.nodes.size(), springs = scene.springs.size(),
                    curves = scene.curves.size();
  for (std::size_t i = 0; i < count; ++i) {
    scene.nodes[i].position[0] += 0.3 - left;
    Node image = scene.nodes[i];
    image.position = mirror * image.position;
    image.velocity = mirror * image.velocity;
    image.load = mirror * image.load;
    if (image.curve >= 0) image.curve += static_cast<int>(curves);
    scene.nodes.push_back(image);
  }
  for (std::size_t c = 0; c < curves; ++c) scene.curves.push_back(scene.curves[c].turned(mirror));
  for (std::size_t e = 0; e < springs; ++e) {
    Spring image = scene.springs[e];
    for (std::size_t& node : image.nodes) node += count;
    scene.springs.push_back(image);
  }
  // A node and its image stay apart along x, or one rod holds them so.
  const bool has_rod = seed % 8 < 4;
  const std::size_t crossing = seed % count, other = (seed / 7) % count;
  const auto join = [&](std::size_t i, bool is_rod) {
    if (scene.nodes[i].pinned) return;
    const double length = 2 * scene.nodes[i].position[0];
    const SpringLaw rod{.rest_length = length, .rigid = true};
    const SpringLaw spring{.stiffness = 20 * scene.nodes[i].mass, .rest_length = 0.8 * length};
    scene.springs.push_back({{i, i + count}, is_rod ? rod : spring});
  };
  join(crossing, has_rod);
  if (other != crossing) join(other, false);
  if (has_rod) {
    // From rest, weights on pins set it off; else it might not move at all.
    for (Node& node : scene.nodes) node.velocity.setZero();
    const bool hangs = std::ranges::any_of(scene.nodes, &Node::pinned);
    if (!scene.curves.empty() || !hangs || scene.gravity.isZero(0)) return {};
  }
  try {
    validate_rods(scene, "mirrored");
  } catch (const InvalidInput&) {
    return {};
  }
  return scene;
}

// A random scene; of one seed of four a mirrored one, if it can be.
inline LinkageScene linkage_or_mirrored(std::uint64_t seed) {
  if (seed % 4 == 3) {
    if (auto scene = mirrored_linkage(seed)) return {std::move(*scene), "mirrored"};
  }
  return LinkageScenes(seed).draw();
}

}  // namespace tests
}  // namespace qddot
