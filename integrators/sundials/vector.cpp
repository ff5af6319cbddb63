#include "qddot/integrators/sundials/vector.hpp"

#include <algorithm>

namespace qddot::sundials {
namespace {

Eigen::Map<Vec> all(N_Vector x) { return {N_VGetArrayPointer(x), N_VGetLength(x)}; }

void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  all(z) = a * all(x) + b * all(y);
}

void scale(double a, N_Vector x, N_Vector z) { all(z) = a * all(x); }

void set_constant(double a, N_Vector z) { all(z).setConstant(a); }

double weighted_norm(N_Vector x, N_Vector weight) {
  return std::sqrt(all(x).cwiseProduct(all(weight)).squaredNorm() /
                   static_cast<double>(N_VGetLength(x)));
}

// z = sum of c_i x_i, piece by piece, so that the sum stays in the nearest cache; z may be an x_i.
int linear_combination(int count, double* c, N_Vector* x, N_Vector z) {
  constexpr Index piece = 256;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, piece, 1> sum;
  const Index n = N_VGetLength(z);
  for (Index first = 0; first < n; first += piece) {
    const Index size = std::min(piece, n - first);
    sum = c[0] * all(x[0]).segment(first, size);
    for (int i = 1; i < count; ++i) sum += c[i] * all(x[i]).segment(first, size);
    all(z).segment(first, size) = sum;
  }
  return 0;
}

// z_i = a_i x + y_i.
int scale_add_multi(int count, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int i = 0; i < count; ++i) all(z[i]) = a[i] * all(x) + all(y[i]);
  return 0;
}

int scale_array(int count, double* c, N_Vector* x, N_Vector* z) {
  for (int i = 0; i < count; ++i) scale(c[i], x[i], z[i]);
  return 0;
}

int linear_sum_array(int count, double a, N_Vector* x, double b, N_Vector* y, N_Vector* z) {
  for (int i = 0; i < count; ++i) linear_sum(a, x[i], b, y[i], z[i]);
  return 0;
}

}  // namespace

Vector make_stock_vector(Index n, SUNContext context) {
  Vector y(check(N_VNew_Serial(2 * n, context)));
  N_VConst(0, y.get());
  return y;
}

Vector make_vector(Index n, SUNContext context) {
  Vector y = make_stock_vector(n, context);
  auto& ops = *y->ops;
  ops.nvlinearsum = linear_sum;
  ops.nvscale = scale;
  ops.nvconst = set_constant;
  ops.nvwrmsnorm = weighted_norm;
  ops.nvlinearcombination = linear_combination;
  ops.nvscaleaddmulti = scale_add_multi;
  ops.nvscalevectorarray = scale_array;
  ops.nvlinearsumvectorarray = linear_sum_array;
  return y;
}

Vector clone(N_Vector y) {
  Vector z(check(N_VClone(y)));
  N_VConst(0, z.get());
  return z;
}

}  // namespace qddot::sundials
