
#include "integrators/sundials/support.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::sundials {
namespace {

Eigen::Map<Vec> all(N_Vector x) { return {N_VGetArrayPointer(x), N_VGetLength(x)}; }

void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const double* const vectors[] = {N_VGetArrayPointer(x), N_VGetArrayPointer(y)};
  const double weights[] = {a, b};
  set_combination(vectors, weights, all(z));
}

void scale(double a, N_Vector x, N_Vector z) {
  const double* const vectors[] = {N_VGetArrayPointer(x)};
  set_combination(vectors, &a, all(z));
}

void set_constant(double a, N_Vector z) { all(z).setConstant(a); }

double weighted_norm(N_Vector x, N_Vector weight) {
  return std::sqrt(all(x).cwiseProduct(all(weight)).squaredNorm() /
                   static_cast<double>(N_VGetLength(x)));
}

// z = sum of c_i x_i; z may be an x_i.
int linear_combination(int count, double* c, N_Vector* x, N_Vector z) {
  constexpr int most_vectors = 64;
  if (count > most_vectors) return 1;
  const double* vectors[most_vectors];
  for (int i = 0; i < count; ++i) vectors[i] = N_VGetArrayPointer(x[i]);
  set_combination({vectors, static_cast<std::size_t>(count)}, c, all(z));
  return 0;
}

// z_i = a_i x + y_i.
int scale_add_multi(int count, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int i = 0; i < count; ++i) add_scaled(all(y[i]), a[i], all(x), all(z[i]));
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

Vector make_stock_vector(Index length, SUNContext context) {
  Vector y(check(N_VNew_Serial(length, context)));
  N_VConst(0, y.get());
  return y;
}

Vector make_vector(Index length, SUNContext context) {
  Vector y = make_stock_vector(length, context);
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
