#pragma once

#include <cstddef>

namespace qddot::inline measure {

// Loops that each reach one limit of a core, with the vector instructions of the springs' kernels.
struct LimitKernels {
  // Multiplies and adds from register to register; returns the number of operations.
  double (*multiply_and_add)(int rounds);
  // a = b + s c of n numbers each.
  void (*triad)(const double* b, const double* c, double s, double* a, std::ptrdiff_t n);
  // Returns the sum of n numbers, n a multiple of 64.
  double (*sum)(const double* x, std::ptrdiff_t n);
};

// The loops for this processor's instructions.
const LimitKernels& limit_kernels();

}  // namespace qddot::inline measure
