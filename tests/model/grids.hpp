#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "qddot/model/mass_spring.hpp"

namespace qddot {
inline namespace tests {

// A grid of `side` nodes a side, spacing 1 m, springs of 100 N/m along its lines and diagonals
// whose rest lengths differ; its nodes in the order given.
struct Grid {
  Network network;
  Vec q;
};
inline Grid grid(int dimension, int side, const std::vector<int>& place) {
  Grid g{{.dimension = dimension, .node_mass = Vec::Ones(side * side)},
         Vec::Zero(dimension * side * side)};
  g.network.uses_constant_stiffness = false;
  const auto join = [&](int i, int j, int i2, int j2) {
    if (i2 >= side || j2 >= side || j2 < 0) return;
    const double rest = 0.8 + 0.01 * ((i * 7 + j * 3) % 11);
    g.network.links.push_back({place[i * side + j], place[i2 * side + j2], {100, rest}});
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double x[] = {i + 0.1 * std::sin(j), j + 0.1 * std::cos(3 * i), 0.2 * std::sin(i * j)};
      std::copy_n(x, dimension, g.q.data() + dimension * place[i * side + j]);
      join(i, j, i + 1, j);
      join(i, j, i, j + 1);
      join(i, j, i + 1, j + 1);
      join(i, j, i + 1, j - 1);
    }
  }
  return g;
}

inline std::vector<int> in_order(int count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  return order;
}
inline std::vector<int> shuffled(int count) {
  std::vector<int> order = in_order(count);
  std::ranges::shuffle(order, std::mt19937(5));
  return order;
}

}  // namespace tests
}  // namespace qddot
