#pragma once

#include <random>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/model.hpp"
#include "tests/integrators/runs.hpp"

namespace qddot {
inline namespace tests {

// A scene as it is and as it is reduced by everything there is.
inline const Reductions with_and_without[] = {Reductions::only({Reduction::pins}), {}};

// The soft cloth of nodes x nodes in its stiff frame.
inline Model framed_cloth(int nodes) {
  return Model(generate(*find_generator("framed_cloth"), {{"nodes", nodes}}, "framed_cloth"));
}

// The state of a scene at t_end; throws where that is not reached.
inline State state_after(const Model& reduced, const Method& method, double h, double t_end) {
  // Solved to rounding where implicit, to compare ends.
  Run r = run(method, reduced.system(), reduced.initial(), t_end,
              {.step_size = h, .solve_tolerance = 1e-12});
  if (r.summary.outcome != Outcome::reached_end) throw std::runtime_error(r.summary.message);
  return r.state;
}
inline std::vector<Node> nodes_after(const Scene& scene, const Reductions& reductions,
                                     const Method& method, double h, double t_end) {
  const Model reduced(scene, reductions);
  return reduced.expand(state_after(reduced, method, h, t_end));
}

// Adds a body of `count` free nodes, 1 m apart in a row from `corner` on, without symmetry. Springs
// join neighbours, second neighbours and some others, stretched and compressed by up to a fifth.
inline void add_random_body(std::mt19937& random, std::size_t count, const Eigen::Vector3d& corner,
                            Scene& scene) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&](double size) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int d = 0; d < scene.dimension; ++d) x[d] = uniform(-size, size);
    return x;
  };
  const std::size_t first = scene.nodes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d place = corner + static_cast<double>(i) * Eigen::Vector3d::UnitX();
    scene.nodes.push_back(
        {.position = place + vector(0.4), .velocity = vector(1), .mass = uniform(0.5, 2)});
  }
  for (std::size_t i = first; i < first + count; ++i) {
    for (std::size_t j = i + 1; j < first + count; ++j) {
      if (j > i + 2 && uniform(0, 1) > 0.2) continue;
      const double length = (scene.nodes[j].position - scene.nodes[i].position).norm();
      scene.springs.push_back({{i, j}, {uniform(50, 200), length * uniform(0.8, 1.2)}});
    }
  }
}

}  // namespace tests
}  // namespace qddot
