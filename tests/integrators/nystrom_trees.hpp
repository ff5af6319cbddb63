#pragma once

#include <cmath>
#include <vector>

#include "qddot/integrators/base/nystrom.hpp"

namespace qddot {
inline namespace tests {

// A term of the Taylor series of q'' = g(q), and its value in the stages of a Nystrom method
// (Hairer, Norsett and Wanner, Solving ODEs I, section II.14). It is a derivative of g, in the
// direction of v for some arguments and in those of the terms `children` for the others. It is
// exact h^(order - 1) in g along the motion, and phi_i h^(order - 1) in stage i.
struct NystromTree {
  int order;
  double exact;
  Vec phi;
  Vec size;  // phi with the absolute value of each coefficient: what rounding is a part of
};

// All such terms up to an order, which are 1, 1, 2, 3, 6, 10, 20, 36, 72, 137, 275 and 541 of order
// 1 to 12.
class NystromTrees {
 public:
  NystromTrees(const NystromPair& pair, int highest_order) {
    const auto s = static_cast<Index>(pair.c.size());
    c_ = Eigen::Map<const Vec>(pair.c.data(), s);
    a_ = Eigen::MatrixXd::Zero(s, s);
    for (Index i = 0; i < s; ++i) {
      for (Index j = 0; j < i; ++j) {
        a_(i, j) = pair.a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      }
    }
    for (int order = 1; order <= highest_order; ++order) {
      // The tree with the same children and as many copies in v as its order needs.
      const std::size_t complete = trees_.size();
      grow({1, 1, Vec::Ones(s), Vec::Ones(s)}, order, 0, complete);
    }
  }

  const std::vector<NystromTree>& all() const { return trees_; }

 private:
  // Adds all trees of `order` that are `stem` with more children, each from trees_[first] on.
  void grow(const NystromTree& stem, int order, std::size_t first, std::size_t complete) {
    NystromTree done = stem;
    done.order = order;
    for (int copy = stem.order; copy < order; ++copy) {
      done.phi = done.phi.cwiseProduct(c_);
      done.size = done.size.cwiseProduct(c_.cwiseAbs());
    }
    trees_.push_back(done);
    for (std::size_t i = first; i < complete; ++i) {
      const NystromTree child = trees_[i];
      if (stem.order + child.order + 1 > order) continue;
      grow({stem.order + child.order + 1,
            stem.exact * child.exact / (child.order * (child.order + 1)),
            stem.phi.cwiseProduct(a_ * child.phi),
            stem.size.cwiseProduct(a_.cwiseAbs() * child.size)},
           order, i, complete);
    }
  }

  Vec c_;
  Eigen::MatrixXd a_;
  std::vector<NystromTree> trees_;
};

// The largest defect of the weights b and b' in their conditions of exactly that order:
//   sum_i b'_i phi_i = exact / r for trees of order r = p,
//   sum_i b_i phi_i = exact / (r (r + 1)) for those of order r = p - 1,
// over all trees; relative to what is added up.
inline double order_defect(const std::vector<NystromTree>& trees, const std::vector<double>& b,
                           const std::vector<double>& b_prime, int p) {
  double largest = 0;
  const auto compare = [&](const std::vector<double>& weights, const NystromTree& tree,
                           double wanted) {
    const Eigen::Map<const Vec> w(weights.data(), tree.phi.size());
    const double miss = std::abs(w.dot(tree.phi) - wanted);
    largest = std::max(largest, miss / w.cwiseAbs().dot(tree.size));
  };
  for (const NystromTree& tree : trees) {
    const int r = tree.order;
    if (r == p) compare(b_prime, tree, tree.exact / r);
    if (r == p - 1) compare(b, tree, tree.exact / (r * (r + 1)));
  }
  return largest;
}

// The larger modulus of the eigenvalues t +- sqrt(t^2 - d), t half the trace and d the determinant.
inline double spectral_radius(const Eigen::Matrix2d& matrix) {
  const double t = matrix.trace() / 2, d = matrix.determinant();
  return t * t < d ? std::sqrt(d) : std::abs(t) + std::sqrt(t * t - d);
}

}  // namespace tests
}  // namespace qddot
