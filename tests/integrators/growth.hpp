#pragma once

#include "tests/integrators/nystrom_trees.hpp"
#include "tests/integrators/runs.hpp"

namespace qddot {
inline namespace tests {

// The larger modulus of the eigenvalues of the matrix of one step on q'' = -q.
inline double growth_a_step(const Method& method, double h) {
  if (method.recurrence_roots) return std::abs(method.recurrence_roots(h, 0).front());
  static const auto system =
      make_mass_spring(Oscillator{.mass = 1, .stiffness = 1}.problem().network);
  Eigen::Matrix2d matrix;
  for (const int column : {0, 1}) {
    const State start{0, Vec::Constant(1, column == 0), Vec::Constant(1, column == 1)};
    const State end = run(method, *system, start, h, {.step_size = h}).state;
    matrix(0, column) = end.q[0];
    matrix(1, column) = end.v[0];
  }
  return spectral_radius(matrix);
}

}  // namespace tests
}  // namespace qddot
