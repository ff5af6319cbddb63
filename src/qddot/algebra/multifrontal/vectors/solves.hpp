#pragma once

#include "qddot/algebra/multifrontal/vectors/strips.hpp"

namespace qddot::multifrontal::QDDOT_LEVEL {
namespace {

// L of the front: strip i from column k on.
const double* factor(const FrontFactor& f, int i, int k) {
  return f.l + (std::ptrdiff_t{i} * f.pivots + k) * height;
}

// Columns of strip j of the pivots.
int columns(const FrontFactor& f, int j) {
  const int after = f.pivots - j * height;
  return height < after ? height : after;
}

void copy(const double* from, std::ptrdiff_t count, double* to) {
  for (std::ptrdiff_t i = 0; i < count; ++i) to[i] = from[i];
}
void clear(double* from, const double* end) {
  while (from < end) *from++ = 0;
}

void forward(const FrontFactor& f, double* y, double* z) {
  const std::ptrdiff_t stride = std::ptrdiff_t{f.pivots} * height;
  copy(y + f.first, f.pivots, z);
  clear(z + f.pivots, z + f.strips * height);
  for (int j = 0; j < f.pivot_strips; ++j) {
    const int k = columns(f, j);
    double* zj = z + j * height;
    solve_lower(factor(f, j, j * height), k, zj);
    subtract_product(factor(f, j + 1, j * height), stride, zj, k, f.strips - j - 1, zj + height);
  }
  copy(z, f.pivots, y + f.first);
  z += f.pivot_strips * height;
  for (int i = 0; i < f.below; ++i) y[f.rows[i]] += z[i];
}

void backward(const FrontFactor& f, double* y, double* x) {
  const std::ptrdiff_t stride = std::ptrdiff_t{f.pivots} * height;
  double* below = x + f.pivot_strips * height;
  copy(y + f.first, f.pivots, x);
  clear(x + f.pivots, below);
  for (int i = 0; i < f.below; ++i) below[i] = y[f.rows[i]];
  clear(below + f.below, x + f.strips * height);
  for (int j = f.pivot_strips; j-- > 0;) {
    const int k = columns(f, j);
    double* xj = x + j * height;
    subtract_transposed(factor(f, j + 1, j * height), stride, xj + height, k, f.strips - j - 1, xj);
    solve_upper(factor(f, j, j * height), k, xj);
  }
  copy(x, f.pivots, y + f.first);
}

void forwards(const FrontFactor& f, double* y, double* z) {
  copy(y + quad * f.first, quad * f.pivots, z);
  clear(z + quad * f.pivots, z + quad * f.pivot_strips * height);
  for (int j = 0; j < f.pivot_strips; ++j) {
    const int before = j * height;
    subtract_products(factor(f, j, 0), z, before, z + quad * before);
    solve_lowers(factor(f, j, before), columns(f, j), z + quad * before);
  }
  copy(z, quad * f.pivots, y + quad * f.first);
  for (int i = 0; i < f.strips - f.pivot_strips; ++i) {
    double sums[quad * height] = {};
    subtract_products(factor(f, f.pivot_strips + i, 0), z, f.pivots, sums);
    for (int r = 0; r < height && i * height + r < f.below; ++r) {
      row(y, f.rows[i * height + r]) += row(sums, r);
    }
  }
}

void backwards(const FrontFactor& f, const double* pivots, double* y, double* x) {
  const std::ptrdiff_t stride = std::ptrdiff_t{f.pivots} * height;
  for (int p = 0; p < f.pivots; ++p) row(x, p) = row(y, f.first + p) / pivots[f.first + p];
  double* below = x + quad * f.pivot_strips * height;
  clear(x + quad * f.pivots, below);
  for (int i = 0; i < f.below; ++i) row(below, i) = row(y, f.rows[i]);
  clear(below + quad * f.below, x + quad * f.strips * height);
  for (int j = f.pivot_strips; j-- > 0;) {
    const int before = j * height, k = columns(f, j);
    double* xj = x + quad * before;
    subtract_transposed_products(factor(f, j + 1, before), stride, xj + quad * height, k,
                                 f.strips - j - 1, xj);
    solve_uppers(factor(f, j, before), k, xj);
  }
  copy(x, quad * f.pivots, y + quad * f.first);
}

}  // namespace
}  // namespace qddot::multifrontal::QDDOT_LEVEL
