#include <atomic>
#include <cmath>
#include <new>
#include <numeric>
#include <omp.h>
#include <sys/mman.h>

#include <suitesparse/cholmod.h>

#include "qddot/algebra/factors.hpp"

namespace qddot {
namespace {

class CholmodFactors : public Factors {
 public:
  CholmodFactors(const SymmetricMatrix& pattern, Vec diagonal)
      : diagonal_(std::move(diagonal)), matrix_(pattern) {
    cholmod_start(&common_);
    common_.print = 0;  // failures are returned, not printed
    // Larger supernodes than the standard 4, 16, 48: nodes' blocks make columns alike, and the
    // numeric phase becomes 15 to 25 % faster on cloths and lattices.
    common_.nrelax[0] = 16;
    common_.nrelax[1] = 48;
    common_.nrelax[2] = 128;
    view_.nrow = view_.ncol = static_cast<std::size_t>(matrix_.rows());
    view_.nzmax = static_cast<std::size_t>(matrix_.nonZeros());
    view_.p = matrix_.outerIndexPtr();
    view_.i = matrix_.innerIndexPtr();
    view_.x = matrix_.valuePtr();
    view_.stype = -1;  // the lower triangle is stored
    view_.itype = CHOLMOD_INT;
    view_.xtype = CHOLMOD_REAL;
    view_.dtype = CHOLMOD_DOUBLE;
    view_.sorted = view_.packed = 1;
    if (matrix_.rows() > 0) factor_ = analyze(CHOLMOD_AUTO);  // CHOLMOD refuses an empty matrix
  }

  ~CholmodFactors() override {
    cholmod_free_dense(&x_, &common_);
    cholmod_free_dense(&y_, &common_);
    cholmod_free_dense(&e_, &common_);
    if (indefinite_factor_) cholmod_free_factor(&indefinite_factor_, &common_);
    if (factor_) cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  CholmodFactors(const CholmodFactors&) = delete;
  CholmodFactors& operator=(const CholmodFactors&) = delete;

  Definiteness factorize(double a, double s, const SymmetricMatrix& k) override {
    if (!factor_) return Definiteness::positive;
    assemble(a, s, k);
    if (numeric(factor_)) return signs(factor_);
    if (!factor_->is_super) return Definiteness::singular;
    // A supernodal LL' stops at the first negative pivot; LDL' goes on.
    if (!indefinite_factor_) indefinite_factor_ = analyze(CHOLMOD_SIMPLICIAL);
    return numeric(indefinite_factor_) ? signs(indefinite_factor_) : Definiteness::singular;
  }

  bool factorize_positive(double a, double s, const SymmetricMatrix& k) override {
    if (!factor_) return true;
    assemble(a, s, k);
    return numeric(factor_) && signs(factor_) == Definiteness::positive;
  }

  Index negative_pivots() const override { return factor_ ? negative_pivots(current_) : 0; }

  Index bytes() const override {
    if (!factor_) return 0;
    if (factor_->is_super) return static_cast<Index>(sizeof(double) * factor_->xsize);
    // Each number is stored with the index of its row.
    const auto* counts = static_cast<const int*>(factor_->ColCount);
    const Index numbers = std::accumulate(counts, counts + factor_->n, Index{0});
    return static_cast<Index>(sizeof(double) + sizeof(int)) * numbers;
  }

  SolveOutcome solve(const Vec& b, Vec& x) override {
    if (!factor_) return SolveOutcome::found;
    cholmod_dense right{};
    right.nrow = right.nzmax = right.d = static_cast<std::size_t>(b.size());
    right.ncol = 1;
    right.x = const_cast<double*>(b.data());  // CHOLMOD reads it only
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    // solve2 keeps its workspace between calls, where cholmod_solve would allocate.
    if (!cholmod_solve2(CHOLMOD_A, current_, &right, nullptr, &x_, nullptr, &y_, &e_, &common_)) {
      throw std::bad_alloc();
    }
    x = Eigen::Map<const Vec>(static_cast<const double*>(x_->x), b.size());
    return SolveOutcome::found;
  }

  SolveOutcome solve(const FourColumns& b, FourColumns& x) override {
    Vec solution(b.rows());
    for (Index c = 0; c < b.cols(); ++c) {
      solve(b.col(c), solution);
      x.col(c) = solution;
    }
    return SolveOutcome::found;
  }

 private:
  void assemble(double a, double s, const SymmetricMatrix& k) {
    matrix_.coeffs() = -s * k.coeffs();
    for (Index j = 0; j < matrix_.cols(); ++j) {
      // The diagonal entry is the first of its column.
      matrix_.valuePtr()[matrix_.outerIndexPtr()[j]] += a * diagonal_[j];
    }
  }

  cholmod_factor* analyze(int kind) {
    common_.supernodal = kind;
    cholmod_factor* factor = cholmod_analyze(&view_, &common_);
    if (!factor) throw std::bad_alloc();
    return factor;
  }

  // OpenBLAS maps a buffer at its first dense product and, if that fails, retries forever. Throws
  // std::bad_alloc if the remaining address space cannot hold one.
  static void require_buffer() {
    constexpr std::size_t buffer = std::size_t{128} << 20;  // its BUFFER_SIZE on x86-64
    void* place = ::mmap(nullptr, buffer, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw std::bad_alloc();
    ::munmap(place, buffer);
  }

  // Whether the numeric factorisation ran through every pivot.
  bool numeric(cholmod_factor* factor) {
    static std::atomic<bool> has_buffer = false;
    if (!has_buffer) require_buffer();
    current_ = factor;
    // CHOLMOD asks for 4 threads whatever OMP_NUM_THREADS is. For parts this small, threads only
    // wait for each other.
    const int levels = omp_get_max_active_levels();
    omp_set_max_active_levels(0);
    cholmod_factorize(&view_, factor, &common_);
    omp_set_max_active_levels(levels);
    if (common_.status < CHOLMOD_OK) {
      throw std::bad_alloc();
    }
    has_buffer = true;
    return factor->minor >= factor->n;
  }

  // The inertia of LDL' is that of D (Sylvester); an LL' that ran through is positive.
  static Index negative_pivots(const cholmod_factor* factor) {
    if (factor->is_ll) return 0;
    const auto* first = static_cast<const int*>(factor->p);
    const auto* value = static_cast<const double*>(factor->x);
    Index count = 0;
    for (std::size_t j = 0; j < factor->n; ++j) count += value[first[j]] < 0;
    return count;
  }

  static Definiteness signs(const cholmod_factor* factor) {
    if (factor->is_ll) return Definiteness::positive;
    const auto* first = static_cast<const int*>(factor->p);
    const auto* value = static_cast<const double*>(factor->x);
    for (std::size_t j = 0; j < factor->n; ++j) {
      const double pivot = value[first[j]];
      if (pivot == 0 || !std::isfinite(pivot)) return Definiteness::singular;
    }
    return negative_pivots(factor) > 0 ? Definiteness::indefinite : Definiteness::positive;
  }

  Vec diagonal_;
  SymmetricMatrix matrix_;
  cholmod_common common_{};
  cholmod_sparse view_{};  // of matrix_
  cholmod_factor* factor_ = nullptr;
  cholmod_factor* indefinite_factor_ = nullptr;
  cholmod_factor* current_ = nullptr;
  cholmod_dense *x_ = nullptr, *y_ = nullptr, *e_ = nullptr;
};

}  // namespace

std::unique_ptr<Factors> make_cholmod_factors(const SymmetricMatrix& pattern, Vec diagonal) {
  return std::make_unique<CholmodFactors>(pattern, std::move(diagonal));
}

}  // namespace qddot
