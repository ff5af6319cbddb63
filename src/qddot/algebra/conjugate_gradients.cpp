#include "qddot/algebra/conjugate_gradients.hpp"

#include <cmath>
#include <limits>

#include "qddot/algebra/block_rows.hpp"
#include "qddot/algebra/dense_pairs.hpp"

namespace qddot {
namespace {

constexpr double safe_tolerance = 1e-10;
constexpr int most_iterations = 10000;

template <int B>
class ConjugateGradients final : public IterativeFactors {
 public:
  ConjugateGradients(const SymmetricMatrix& pattern, const std::vector<int>& starts, Vec diagonal)
      : diagonal_(std::move(diagonal)),
        matrix_(pattern, starts),
        inverse_(B * matrix_.size() + Rows::slack),
        x_(matrix_.size()),
        r_(matrix_.size()),
        z_(matrix_.size()),
        p_(matrix_.size()),
        q_(matrix_.size()) {}

  Definiteness factorize(double a, double s, const SymmetricMatrix& k) override {
    matrix_.assemble(a, diagonal_, s, k);
    return definiteness_ = invert_blocks();
  }

  bool factorize_positive(double a, double s, const SymmetricMatrix& k) override {
    return factorize(a, s, k) == Definiteness::positive;
  }

  Index negative_pivots() const override { return definiteness_ == Definiteness::indefinite; }

  Index bytes() const override {
    return static_cast<Index>(sizeof(double)) * (matrix_.entries() + B * matrix_.size());
  }

  Index iterations() const override { return iterations_; }

  void set_tolerance(double tolerance) override { tolerance_ = tolerance; }

  SolveOutcome solve(const Vec& b, Vec& x) override {
    x.resize(b.size());
    if (definiteness_ != Definiteness::positive) return SolveOutcome::indefinite;
    matrix_.spread(b.data(), r_.get());
    const SolveOutcome solution = iterate();
    if (solution == SolveOutcome::indefinite) definiteness_ = Definiteness::indefinite;
    matrix_.gather(x_.get(), x.data());
    return solution;
  }

  SolveOutcome solve(const FourColumns& b, FourColumns& x) override {
    Vec one(b.rows());
    for (Index c = 0; c < b.cols(); ++c) {
      if (const SolveOutcome s = solve(b.col(c), one); s != SolveOutcome::found) return s;
      x.col(c) = one;
    }
    return SolveOutcome::found;
  }

 private:
  using Rows = BlockRows<B>;
  using Lanes = typename Rows::Lanes;
  using Block = typename Rows::Block;

  // A x = r, from x = 0.
  SolveOutcome iterate() {
    auto x = all(x_), r = all(r_), z = all(z_), p = all(p_), q = all(q_);
    x.setZero();
    double rz = precondition();
    if (!std::isfinite(rz)) {  // a direct solver also returns such a result
      x.setConstant(std::numeric_limits<double>::quiet_NaN());
      return SolveOutcome::found;
    }
    const double target = tolerance_ * tolerance_ * rz;
    p = z;
    for (int i = 0; rz > target; ++i) {
      if (i == most_iterations) return SolveOutcome::not_converged;
      ++iterations_;
      const double curvature = matrix_.multiply(p_.get(), q_.get());
      if (!(curvature > 0)) return SolveOutcome::indefinite;
      const double length = rz / curvature;
      x += length * p;
      r -= length * q;
      const double before = rz;
      rz = precondition();
      p = z + (rz / before) * p;
    }
    return SolveOutcome::found;
  }

  // z = P^-1 r; returns r'z.
  double precondition() {
    double product = 0;
    const double *inverse = inverse_.get(), *r = r_.get();
    double* z = z_.get();
    for (Index i = 0; i < matrix_.rows(); ++i, inverse += B * B, r += B, z += B) {
      Lanes sum = Lanes::Zero();
      for (int c = 0; c < B; ++c) sum += Eigen::Map<const Lanes>(inverse + B * c) * r[c];
      for (int c = 0; c < B; ++c) {
        z[c] = sum[c];
        product += sum[c] * r[c];
      }
    }
    return product;
  }

  Definiteness invert_blocks() {
    for (Index i = 0; i < matrix_.rows(); ++i) {
      const Block block = matrix_.diagonal(i);
      if (!block.allFinite()) return Definiteness::singular;
      if (!invert_positive(block, inverse_.get() + B * B * i)) {
        const bool has_negative = dense_values(block).minCoeff() < 0;
        return has_negative ? Definiteness::indefinite : Definiteness::singular;
      }
    }
    return Definiteness::positive;
  }

  // The inverse of a positive definite block by its L L'; false for any other. Eigen's, for any
  // size, takes seconds to compile for each of these.
  static bool invert_positive(const Block& block, double* inverse) {
    Block l = block;
    for (int j = 0; j < B; ++j) {
      for (int k = 0; k < j; ++k) l(j, j) -= l(j, k) * l(j, k);
      if (!(l(j, j) > 0)) return false;
      l(j, j) = std::sqrt(l(j, j));
      for (int i = j + 1; i < B; ++i) {
        for (int k = 0; k < j; ++k) l(i, j) -= l(i, k) * l(j, k);
        l(i, j) /= l(j, j);
      }
    }
    for (int c = 0; c < B; ++c, inverse += B) {
      for (int i = 0; i < B; ++i) {  // L x = e_c
        inverse[i] = i == c;
        for (int k = 0; k < i; ++k) inverse[i] -= l(i, k) * inverse[k];
        inverse[i] /= l(i, i);
      }
      for (int i = B; i-- > 0;) {  // L' x = that
        for (int k = i + 1; k < B; ++k) inverse[i] -= l(k, i) * inverse[k];
        inverse[i] /= l(i, i);
      }
    }
    return true;
  }

  Eigen::Map<Vec> all(const LargeArray& array) const { return {array.get(), matrix_.size()}; }

  Vec diagonal_;
  Rows matrix_;
  LargeArray inverse_;  // of the blocks on the diagonal
  LargeArray x_, r_, z_, p_, q_;
  Definiteness definiteness_ = Definiteness::singular;
  double tolerance_ = safe_tolerance;
  Index iterations_ = 0;
};

}  // namespace

std::unique_ptr<IterativeFactors> make_conjugate_gradients(const SymmetricMatrix& pattern,
                                                           Vec diagonal) {
  static_assert(most_block_unknowns == 3);
  const std::vector<int> starts = block_starts(pattern);
  int largest = 1;
  for (std::size_t i = 1; i < starts.size(); ++i) {
    largest = std::max(largest, starts[i] - starts[i - 1]);
  }
  if (largest == 1)
    return std::make_unique<ConjugateGradients<1>>(pattern, starts, std::move(diagonal));
  if (largest == 2)
    return std::make_unique<ConjugateGradients<2>>(pattern, starts, std::move(diagonal));
  return std::make_unique<ConjugateGradients<3>>(pattern, starts, std::move(diagonal));
}

}  // namespace qddot
