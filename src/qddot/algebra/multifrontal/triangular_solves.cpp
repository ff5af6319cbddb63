#include "qddot/algebra/multifrontal/triangular_solves.hpp"

#include <algorithm>

#include "qddot/model/vector_updates.hpp"

namespace qddot::multifrontal {
namespace {

constexpr int quad = FourColumns::ColsAtCompileTime;

}  // namespace

TriangularSolves::TriangularSolves(const Fronts& fronts, const double* l, const double* pivots)
    : fronts_(fronts),
      l_(l),
      pivot_(pivots),
      y_(quad * std::ssize(fronts.place())),
      gathered_(quad * std::max(fronts.branch_sizes.height, fronts.top_sizes.height)) {}

void TriangularSolves::solve(const Vec& b, Vec& x) {
  const auto& place = fronts_.place();
  double *y = y_.get(), *z = gathered_.get();
  for (Index i = 0; i < b.size(); ++i) y[place[i]] = b[i];
  for (const Front& f : fronts_) kernels_.forward(factor(f), y, z);
  const Eigen::Map<const Vec> pivots(pivot_, b.size());
  Eigen::Map<Vec> unknowns(y, b.size());
  divide(unknowns, pivots, unknowns);
  for (const Front* f = fronts_.end(); f != fronts_.begin();) kernels_.backward(factor(*--f), y, z);
  x.resize(b.size());
  for (Index i = 0; i < b.size(); ++i) x[i] = y[place[i]];
}

void TriangularSolves::solve(const FourColumns& b, FourColumns& x) {
  const auto& place = fronts_.place();
  double *y = y_.get(), *z = gathered_.get();
  for (Index i = 0; i < b.rows(); ++i) std::copy_n(b.data() + quad * i, quad, y + quad * place[i]);
  for (const Front& f : fronts_) kernels_.forwards(factor(f), y, z);
  for (const Front* f = fronts_.end(); f != fronts_.begin();) {
    kernels_.backwards(factor(*--f), pivot_, y, z);
  }
  for (Index i = 0; i < b.rows(); ++i) std::copy_n(y + quad * place[i], quad, x.data() + quad * i);
}

FrontFactor TriangularSolves::factor(const Front& f) const {
  return {.l = l_ + f.factor,
          .first = f.first,
          .pivots = f.pivots,
          .pivot_strips = f.pivot_strips(),
          .strips = f.strips(),
          .below = f.below,
          .rows = fronts_.rows(f).data()};
}

}  // namespace qddot::multifrontal
