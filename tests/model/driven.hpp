#pragma once

#include "tests/problems.hpp"

namespace qddot {
inline namespace tests {

// The network driven in every way: its anchors move by harmonics, by a polynomial and, if
// `has_table`, by a spline; loads push two nodes, and an acceleration all of them. Every curve is
// zero at t = 0.
inline Network driven(Network network, bool has_table = false) {
  using Vector = Eigen::Vector3d;
  const Vector by = Vector{1, -0.7, 0.4}.head(network.dimension).norm() * Vector{0.15, -0.1, 0.12};
  const auto in_space = [&](double x, double y, double z) {
    Vector all(x, y, z);
    all.tail(3 - network.dimension).setZero();
    return all;
  };
  network.curves = {
      {.harmonics = {{in_space(by[0], by[1], by[2]), 5, 0}, {in_space(0.05, 0.1, 0), 11, 0}}},
      {.polynomial = {Vector::Zero(), in_space(0.2, 0.1, -0.1), in_space(-0.3, 0.2, 0.1)}},
      {.harmonics = {{in_space(3, 2, -2), 7, 0.4}}},
      {.polynomial = {Vector::Zero(), in_space(-2, 1, 3)}}};
  if (has_table) {
    network.curves[1].tables = {PiecewiseCubic::spline(
        {0, 0.21, 0.37, 0.6, 0.83, 1},
        {Vector::Zero(), in_space(0.1, 0, 0.05), in_space(0.12, -0.1, 0), in_space(-0.1, 0.1, 0),
         in_space(0, 0.1, 0.1), in_space(0.05, 0, 0)})};
  }
  int number = 0;
  for (auto& anchor : network.anchors) anchor.curve = number++ % 2;
  const int nodes = static_cast<int>(network.node_mass.size());
  for (int i = 0; i < nodes; ++i) {
    const double mass = network.node_mass[i];
    network.driven_loads.push_back({i, 3, mass, in_space(0.3, 0.1 * i, 0)});
  }
  network.driven_loads.push_back({0, 2, 1, Vector::Zero()});
  network.driven_loads.push_back({nodes - 1, 2, -0.5, in_space(1, 0, 0)});
  return network;
}

}  // namespace tests
}  // namespace qddot
