#include "experiments/advice/hard_scenes.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "qddot/analysis/largest_frequency.hpp"

namespace qddot::judged_advice {

Eigen::Vector3d random_direction(Draws& draw, int d) {
  for (;;) {
    const Eigen::Vector3d x = draw.in_box(d, 1);
    if (x.norm() > 0.1 && x.norm() < 1) return x.normalized();
  }
}

void turn(Scene& scene, Draws& draw) {
  if (scene.dimension == 1) return;
  if (scene.dimension == 2 && draw.happens(0.4)) scene.dimension = 3;
  const Eigen::Vector3d axis =
      scene.dimension == 2 ? Eigen::Vector3d(0, 0, 1) : random_direction(draw, scene.dimension);
  const Eigen::Matrix3d r = Eigen::AngleAxisd(draw.between(0.1, 3), axis).toRotationMatrix();
  const auto turned = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return r * x; };
  for (Node& node : scene.nodes) {
    node.position = turned(node.position);
    node.velocity = turned(node.velocity);
  }
  scene.gravity = turned(scene.gravity);
}

void join(Scene& scene, std::size_t i, std::size_t j, double k, double l0, double c) {
  scene.springs.push_back({{i, j}, {.stiffness = k, .rest_length = l0, .quartic = c}});
}

double apart(const Scene& scene, std::size_t i, std::size_t j) {
  return (scene.nodes[i].position - scene.nodes[j].position).norm();
}

double fastest(const HardCase& c) {
  const Model model = c.as_drawn();
  const double w = frequency_at_least(model.system(), model.initial().q);
  return w > 0 && std::isfinite(w) ? w : 1;
}

Scene net(Draws& draw, int d, int nodes, double strain, bool is_pinned) {
  Scene scene{.dimension = d};
  const double box = 0.7 * std::pow(nodes, 1.0 / d) + 0.3;
  for (int i = 0; i < nodes; ++i) {
    Node node{.mass = draw.by_logarithm(0.05, 3)};
    for (int attempt = 0; attempt < 200; ++attempt) {
      node.position = draw.in_box(d, box);
      if (std::ranges::all_of(scene.nodes, [&](const Node& other) {
            return (other.position - node.position).norm() > 0.35;
          }))
        break;
    }
    scene.nodes.push_back(node);
  }
  scene.nodes[0].pinned = is_pinned;
  const auto count = static_cast<std::size_t>(nodes);
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool is_of_tree = j == (i - 1) / 2 || j + 1 == i;
      if (!is_of_tree && !draw.happens(0.3)) continue;
      const double l0 = apart(scene, i, j) * (1 + strain * draw.between(-1, 1));
      join(scene, j, i, draw.by_logarithm(3, 100), l0);
    }
  }
  return scene;
}

}  // namespace qddot::judged_advice
