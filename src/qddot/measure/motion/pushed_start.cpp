#include "qddot/measure/motion/pushed_start.hpp"

#include <algorithm>

namespace qddot::inline measure {

State pushed_start(const Model& model, const Scales& scales, const Push& push) {
  State start = model.initial();
  Shift shift(push);
  Index at = 0;
  std::size_t part = 0;
  for (const Index n : model.unknowns_by_part()) {
    const PartScale& own = scales.parts[part++];
    for (Index i = at; i < at + n; ++i) {
      shift(start.q[i], std::max(own.extent, own.displacement));
      shift(start.v[i], own.speed);
    }
    at += n;
  }
  return start;
}

Scene pushed_scene(const Scene& drawn, const Scales& scales, const Push& push) {
  Scene scene = drawn;
  std::vector<double> sizes, speeds(scene.nodes.size(), 0);
  for (const Node& node : scene.nodes) sizes.push_back(node.position.lpNorm<Eigen::Infinity>());
  for (const PartScale& part : scales.parts) {
    for (const std::size_t i : part.nodes) {
      sizes[i] = std::max({sizes[i], part.extent, part.displacement});
      speeds[i] = part.speed;
    }
  }
  const double largest = sizes.empty() ? 0 : std::ranges::max(sizes);
  Shift shift(push);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    Node& node = scene.nodes[i];
    for (int c = 0; c < scene.dimension; ++c) {
      shift(node.position[c], sizes[i]);
      if (!node.pinned) shift(node.velocity[c], speeds[i]);
    }
  }
  // A push of both ends hides that of a rest length, unless it is longer than all the scene. Equal
  // springs stay equal, which makes the forces of a large scene faster.
  for (Spring& spring : scene.springs) {
    if (spring.law.rest_length > largest) shift(spring.law.rest_length, spring.law.rest_length);
  }
  return scene;
}

}  // namespace qddot::inline measure
