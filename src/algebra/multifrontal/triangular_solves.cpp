#include "qddot/algebra/multifrontal/triangular_solves.hpp"

#include <algorithm>

#include "qddot/algebra/multifrontal/strips.hpp"

namespace qddot::multifrontal {

using namespace strips;

namespace {

Index stride(const Front& f) { return Index{f.pivots} * height; }

}  // namespace

TriangularSolves::TriangularSolves(const Fronts& fronts, const double* l, const double* pivots)
    : fronts_(fronts),
      l_(l),
      pivot_(pivots),
      y_(quad * std::ssize(fronts.place())),
      gathered_(quad * std::max(fronts.branch_sizes.height, fronts.top_sizes.height)) {}

void TriangularSolves::solve(const Vec& b, Vec& x) {
  const auto& place = fronts_.place();
  for (Index i = 0; i < b.size(); ++i) y_.get()[place[i]] = b[i];
  for (const Front& f : fronts_) forward(f);
  for (Index i = 0; i < b.size(); ++i) y_.get()[i] /= pivot_[i];
  for (const Front* f = fronts_.end(); f != fronts_.begin();) backward(*--f);
  x.resize(b.size());
  for (Index i = 0; i < b.size(); ++i) x[i] = y_.get()[place[i]];
}

void TriangularSolves::solve(const FourColumns& b, FourColumns& x) {
  const auto& place = fronts_.place();
  for (Index i = 0; i < b.rows(); ++i) row(y_.get(), place[i]) = row(b.data(), i);
  for (const Front& f : fronts_) forwards(f);
  for (const Front* f = fronts_.end(); f != fronts_.begin();) backwards(*--f);
  for (Index i = 0; i < b.rows(); ++i) row(x.data(), i) = row(y_.get(), place[i]);
}

void TriangularSolves::forward(const Front& f) {
  double* z = gathered_.get();
  std::copy_n(y_.get() + f.first, f.pivots, z);
  std::fill(z + f.pivots, z + f.height(), 0.0);
  for (int j = 0; j < f.pivot_strips(); ++j) {
    const int k = std::min(height, f.pivots - j * height);
    double* zj = z + j * height;
    solve_lower(factor(f, j, j * height), k, zj);
    subtract_product(factor(f, j + 1, j * height), stride(f), zj, k, f.strips() - j - 1,
                     zj + height);
  }
  std::copy_n(z, f.pivots, y_.get() + f.first);
  z += f.pivot_height();
  for (const int row : fronts_.rows(f)) y_.get()[row] += *z++;
}

void TriangularSolves::backward(const Front& f) {
  double* x = gathered_.get();
  std::copy_n(y_.get() + f.first, f.pivots, x);
  std::fill(x + f.pivots, x + f.pivot_height(), 0.0);
  double* below = x + f.pivot_height();
  for (const int row : fronts_.rows(f)) *below++ = y_.get()[row];
  std::fill(below, x + f.height(), 0.0);
  for (int j = f.pivot_strips(); j-- > 0;) {
    const int k = std::min(height, f.pivots - j * height);
    double* xj = x + j * height;
    subtract_transposed(factor(f, j + 1, j * height), stride(f), xj + height, k, f.strips() - j - 1,
                        xj);
    solve_upper(factor(f, j, j * height), k, xj);
  }
  std::copy_n(x, f.pivots, y_.get() + f.first);
}

void TriangularSolves::forwards(const Front& f) {
  double* z = gathered_.get();
  std::copy_n(y_.get() + quad * f.first, quad * f.pivots, z);
  std::fill(z + quad * f.pivots, z + quad * f.pivot_height(), 0.0);
  for (int j = 0; j < f.pivot_strips(); ++j) {
    const int before = j * height, k = std::min(height, f.pivots - before);
    subtract_products(factor(f, j, 0), z, before, z + quad * before);
    solve_lowers(factor(f, j, before), k, z + quad * before);
  }
  std::copy_n(z, quad * f.pivots, y_.get() + quad * f.first);
  const auto rows = fronts_.rows(f);
  for (int i = 0; i < f.below_strips(); ++i) {
    double sums[quad * height] = {};
    subtract_products(factor(f, f.pivot_strips() + i, 0), z, f.pivots, sums);
    const int count = std::min(height, f.below - i * height);
    for (int r = 0; r < count; ++r) row(y_.get(), rows[i * height + r]) += row(sums, r);
  }
}

void TriangularSolves::backwards(const Front& f) {
  double* x = gathered_.get();
  for (int p = 0; p < f.pivots; ++p) {
    row(x, p) = row(y_.get(), f.first + p) / pivot_[f.first + p];
  }
  std::fill(x + quad * f.pivots, x + quad * f.pivot_height(), 0.0);
  int at = f.pivot_height();
  for (const int i : fronts_.rows(f)) row(x, at++) = row(y_.get(), i);
  std::fill(x + quad * at, x + quad * f.height(), 0.0);
  for (int j = f.pivot_strips(); j-- > 0;) {
    const int before = j * height, k = std::min(height, f.pivots - before);
    double* xj = x + quad * before;
    subtract_transposed_products(factor(f, j + 1, before), stride(f), xj + quad * height, k,
                                 f.strips() - j - 1, xj);
    solve_uppers(factor(f, j, before), k, xj);
  }
  std::copy_n(x, quad * f.pivots, y_.get() + quad * f.first);
}

}  // namespace qddot::multifrontal
