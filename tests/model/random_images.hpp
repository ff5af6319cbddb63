#pragma once

#include <random>

#include "tests/model/differences.hpp"
#include "tests/problems.hpp"

namespace qddot {
inline namespace tests {

// A network with image links and a point of it.
struct ImageSample {
  Network network;
  Vec q;
};

constexpr int image_nodes = 6;

// Six nodes in a row with springs of all kinds between any two of them, gravity and loads. There
// are links and images in both directions and several times, images in no mirror and of a node
// itself, and springs without stiffness; node 2 is joined to all. Each spring starts at `stretch`
// times its rest length and is at least 0.5 m long.
// `on_planes`: whether some coordinates stay zero, all those of node 4 among them.
inline ImageSample random_images(std::mt19937& random, int dimension, double stretch,
                                 bool on_planes) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&](double low, double high) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int d = 0; d < dimension; ++d) x[d] = uniform(low, high);
    return x;
  };
  const auto mirror = [&] {
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    const int some = std::uniform_int_distribution(1, (1 << dimension) - 1)(random);
    for (int d = 0; d < dimension; ++d) signs[d] = some >> d & 1 ? -1 : 1;
    return signs;
  };
  const auto law = [&](double length) {
    return SpringLaw{.stiffness = std::max(0.0, uniform(-20, 200)),
                     .rest_length = length / stretch,
                     .quartic = uniform(0, 1) < 0.5 ? uniform(10, 50) : 0};
  };

  ImageSample s{{.dimension = dimension, .gravity = vector(-10, 10), .node_mass = Vec(image_nodes)},
                {}};
  for (double& m : s.network.node_mass) m = uniform(0.5, 2);
  s.network.load = Vec(dimension * image_nodes);
  for (double& f : s.network.load) f = uniform(-20, 20);
  s.network.constant_energy = 3;
  if (on_planes) s.network.zero_coordinates = {0, 1, 2, 4, 7, 0};
  std::vector<Eigen::Vector3d> x;
  std::vector<double> q;
  for (int i = 0; i < image_nodes; ++i) {
    x.push_back(vector(0.7, 1.3) + i * Eigen::Vector3d::UnitX());
    for (int d = 0; d < dimension; ++d) {
      if (is_unknown(s.network, i, d)) {
        q.push_back(x[i][d]);
      } else {
        x[i][d] = 0;
      }
    }
  }
  s.q = Vec::Map(q.data(), std::ssize(q));

  const auto join = [&](int i, int j, const Eigen::Vector3d& signs) {
    const double length = (signs.cwiseProduct(x[j]) - x[i]).norm();
    if (length < 0.5) return;
    if (signs == Eigen::Vector3d::Ones() && i < j) {
      s.network.links.push_back({i, j, law(length)});
    } else {
      s.network.image_links.push_back({i, j, signs, law(length)});
    }
  };
  for (int i = 0; i < image_nodes; ++i) {
    for (int j = 0; j < image_nodes; ++j) {
      if (i == 2 || j == 2 || uniform(0, 1) < 0.3) join(i, j, mirror());
      if (i != j && uniform(0, 1) < 0.2) join(i, j, Eigen::Vector3d::Ones());
    }
    join(i, i, mirror());
  }
  for (int several = 0; several < 3; ++several) {
    join(0, 5, mirror());
    join(5, 0, mirror());
  }
  for (const int i : {0, 5}) {
    const Eigen::Vector3d point = vector(-0.3, 0.3) + (i - 1.5) * Eigen::Vector3d::UnitX();
    const double length = (point - x[i]).norm();
    if (length > 0.5) s.network.anchors.push_back({i, point, law(length)});
  }
  return s;
}

// Calls check(network, q) in each dimension, with all springs at the given stretches. There are
// three networks of links and anchors, and as many with images, with and without planes.
template <class Check>
void for_networks(std::initializer_list<double> stretches, const Check& check) {
  std::mt19937 random(17);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : stretches) {
      for (int i = 0; i < 9; ++i) {
        const Problem p = random_network(random, dimension, 6, stretch);
        const ImageSample s = random_images(random, dimension, stretch, i % 3 == 1);
        i % 3 == 2 ? check(p.network, p.initial.q) : check(s.network, s.q);
      }
    }
  }
}

}  // namespace tests
}  // namespace qddot
