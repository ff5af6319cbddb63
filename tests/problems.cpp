#include "tests/problems.hpp"

#include <utility>

namespace qddot {
inline namespace tests {

Eigen::Vector3d in_space(const Vec& x) {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (Index d = 0; d < x.size(); ++d) point[d] = x[d];
  return point;
}

Problem random_network(std::mt19937& random, int dimension, int nodes, double stretch) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto point = [&](int place) {
    Vec x(dimension);
    for (double& coordinate : x) coordinate = uniform(-0.3, 0.3);
    x[0] += place;
    return x;
  };
  const auto law = [&](double length) {
    return SpringLaw{.stiffness = uniform(50, 200),
                     .rest_length = length / stretch,
                     .quartic = uniform(0, 1) < 0.5 ? uniform(10, 50) : 0};
  };

  Problem p;
  p.network.dimension = dimension;
  p.network.node_mass.resize(nodes);
  p.initial.q.resize(dimension * nodes);
  p.initial.v.resize(dimension * nodes);
  for (int d = 0; d < dimension; ++d) p.network.gravity[d] = uniform(-10, 10);
  for (double& m : p.network.node_mass) m = uniform(0.5, 2);
  for (double& v : p.initial.v) v = uniform(-1, 1);
  for (int i = 0; i < nodes; ++i) p.initial.q.segment(dimension * i, dimension) = point(i);

  const auto at = [&](int i) -> Vec { return p.initial.q.segment(dimension * i, dimension); };
  const auto join = [&](int i, int j) {
    if (uniform(0, 1) < 0.5) std::swap(i, j);
    p.network.links.push_back({i, j, law((at(i) - at(j)).norm())});
  };
  for (int i = 0; i + 1 < nodes; ++i) join(i, i + 1);
  for (int extra = 0; extra < nodes; ++extra) {
    const int i = std::uniform_int_distribution(0, nodes - 1)(random);
    const int j = std::uniform_int_distribution(0, nodes - 1)(random);
    if (i != j) join(i, j);
  }
  if (nodes > 1) join(0, 1);  // a second time
  for (const int i : {0, nodes - 1}) {
    const Vec x = point(i == 0 ? -1 : nodes);
    p.network.anchors.push_back({i, in_space(x), law((at(i) - x).norm())});
  }
  return p;
}

Network row_of_masses(int dimension, int n, double mass, const SpringLaw& law) {
  Network row{.dimension = dimension, .node_mass = Vec::Constant(n, mass)};
  for (int i = 0; i + 1 < n; ++i) row.links.push_back({i, i + 1, law});
  row.anchors = {{0, {0, 0, 0}, law}, {n - 1, {n + 1.0, 0, 0}, law}};
  return row;
}

Network with_split(Network network) {
  const auto name_stiff = [](auto& springs) {
    for (std::size_t e = 0; e < springs.size(); e += 2) springs[e].stiff = true;
  };
  name_stiff(network.links);
  name_stiff(network.image_links);
  name_stiff(network.anchors);
  network.offers_split = true;
  return network;
}

Network without_quartic(Network network) {
  for_springs(network, [](auto& spring) { spring.law.quartic = 0; });
  return network;
}

Network without_rest_lengths(Network network) {
  for_springs(network, [](auto& spring) { spring.law.rest_length = spring.law.quartic = 0; });
  return network;
}

Problem hammock(int dimension) {
  Problem p;
  p.network.dimension = dimension;
  p.network.gravity[dimension - 1] = -9.81;
  p.network.node_mass = Vec{{1.0, 1.5, 0.8, 1.2}};
  p.initial.q.resize(4 * dimension);
  p.initial.v.resize(4 * dimension);
  for (int i = 0; i < 4; ++i) {
    Vec x = Vec::Zero(dimension), v = Vec::Zero(dimension);
    if (dimension == 3) x[1] = 0.15 * i;
    x[0] = i + 1.0;
    v[0] = 0.3;
    x[dimension - 1] += i % 2 == 0 ? -0.2 : 0.1;
    v[dimension - 1] += 0.5 - 0.4 * i;
    p.initial.q.segment(dimension * i, dimension) = x;
    p.initial.v.segment(dimension * i, dimension) = v;
  }
  p.network.links = {{0, 1, {60, 1.1}},
                     {1, 2, {60, 0.9, 40}},
                     {3, 2, {60, 1.0}},
                     {0, 2, {20, 2.0}},
                     {3, 1, {20, 2.1}}};
  p.network.anchors = {{0, {0, 0, 0}, {80, 0.9}}, {3, {5, 0, 0}, {80, 1.0}}};
  return p;
}

}  // namespace tests
}  // namespace qddot
