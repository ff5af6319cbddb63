#pragma once

#include <cstddef>

namespace qddot::inline measure {

// Loops that reach one limit of a core each, with the vector instructions of the springs' kernels.
struct LimitKernels {
  // Multiplies and adds from register to register; returns the number of operations.
  double (*multiply_and_add)(int rounds);
  // a = b + s c of n numbers each.
  void (*triad)(const double* b, const double* c, double s, double* a, std::ptrdiff_t n);
  // Returns the sum of n numbers, n a multiple of 64.
  double (*sum)(const double* x, std::ptrdiff_t n);
};

// Returns the version in use.
const LimitKernels& limit_kernels();

}  // namespace qddot::inline measure
