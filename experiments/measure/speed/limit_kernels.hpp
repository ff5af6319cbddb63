#pragma once

#include <cstddef>

namespace qddot::measure {

// Passes that do one thing as fast as a core can, by the vectors that the springs' kernels use.
struct LimitKernels {
  // Multiplies and adds from register to register; returns how many operations that were.
  double (*multiply_and_add)(int rounds);
  // a = b + s c of n numbers each.
  void (*triad)(const double* b, const double* c, double s, double* a, std::ptrdiff_t n);
  // Returns the sum of n numbers, n a multiple of 64.
  double (*sum)(const double* x, std::ptrdiff_t n);
};

// Returns the version in use.
const LimitKernels& limit_kernels();

}  // namespace qddot::measure
