#pragma once

#include <cstddef>

// The data that vector kernels read and write: plain numbers only, as in spring_kernels.hpp.
namespace qddot::kernels {

// Masses, and the numbers nearest to their inverses: n of them, or one if all are the same, or
// nullptr; see Mass.
struct Masses {
  const double *m, *inverse;
  bool is_uniform;
};

// One version's functions on n numbers; `out` may be one of the others.
struct VectorKernels {
  // out = x + c z
  void (*add_scaled)(const double* x, double c, const double* z, double* out, std::ptrdiff_t n);
  // out = x + c f/m, number by number.
  void (*add_quotient)(const double* x, double c, const double* f, const Masses& m, double* out,
                       std::ptrdiff_t n);
  // w = (v + c0 f/m) + c f/m and q' = q + h w, number by number.
  void (*kick_and_drift)(const double* q, const double* v, const double* f, const Masses& m,
                         double c0, double c, double h, double* q_next, double* w,
                         std::ptrdiff_t n);
  // w = v + h/2 f/m, q' = q + h w and kicked = v + h f/m, number by number.
  void (*half_kick_and_drift)(const double* q, const double* v, const double* f, const Masses& m,
                              double h, double* q_next, double* w, double* kicked,
                              std::ptrdiff_t n);
  // out = f/m and out = a b, number by number.
  void (*divide)(const double* f, const Masses& m, double* out, std::ptrdiff_t n);
  void (*multiply)(const double* a, const double* b, double* out, std::ptrdiff_t n);
  // out = x + d v + c (b_0 z_0 + b_1 z_1 + ...) of `count` vectors, without x or v if that is
  // nullptr.
  void (*add_combination)(const double* x, double d, const double* v, double c,
                          const double* const* z, const double* b, int count, double* out,
                          std::ptrdiff_t n);
  // A step of a multistep method; u has the u_1 ... u_count of earlier steps:
  //   u_0 = c f - (r_1 u_1 + r_2 u_2 + ...),   d' = d + b_0 u_0 + b_1 u_1 + ...,
  //   q' = q + d'.
  void (*step_by_history)(const double* f, const double* c, const double* const* u, const double* r,
                          const double* b, int count, const double* q, const double* d, double* u_0,
                          double* d_next, double* q_next, std::ptrdiff_t n);
  // x_0^2 + x_1^2 + ...
  double (*squared_norm)(const double* x, std::ptrdiff_t n);
  // a.b and (a + b).c
  double (*product)(const double* a, const double* b, std::ptrdiff_t n);
  double (*product_with_sum)(const double* a, const double* b, const double* c, std::ptrdiff_t n);
  // |v + c f/m|^2
  double (*squared_norm_of_kicked)(const double* v, double c, const double* f, const Masses& m,
                                   std::ptrdiff_t n);
  // The squared norm of x_i/(rtol |y_i| + atol).
  double (*squared_error)(const double* x, double rtol, const double* y, double atol,
                          std::ptrdiff_t n);
};

// Returns the version in use.
const VectorKernels& vector_kernels();

}  // namespace qddot::kernels
