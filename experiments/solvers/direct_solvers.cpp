#include "experiments/solvers/direct_solvers.hpp"

#include <cmath>
#include <cstdint>
#include <new>
#include <stdexcept>

#include <Eigen/SparseCholesky>
#include <suitesparse/klu.h>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"
#include "qddot/model/first_order.hpp"

namespace qddot::solvers {
namespace {

class OwnSolver final : public DirectSolver {
 public:
  OwnSolver(const System& system, Solver solver)
      : system_(system), is_counted_(solver == Solver::multifrontal), factors_(system, solver) {}
  bool factorize(double s, const SymmetricMatrix& k) override {
    if (is_counted_ && flops == 0) count();
    return factors_.factorize(1, s, k) != EffectiveMass::Definiteness::singular;
  }
  void solve(const Vec& b, Vec& x) override { factors_.solve(b, x); }

 private:
  void count() {
    const SymbolicFactorization symbolic = analyse(system_.stiffness_pattern());
    flops = symbolic.operations();
    bytes = sizeof(double) * symbolic.entries();
  }

  const System& system_;
  bool is_counted_;
  EffectiveMass factors_;
};

class EigenSolver final : public DirectSolver {
 public:
  explicit EigenSolver(const System& system)
      : mass_(system.mass()), matrix_(system.stiffness_pattern()) {
    factors_.analyzePattern(matrix_);
  }
  bool factorize(double s, const SymmetricMatrix& k) override {
    matrix_.coeffs() = -s * k.coeffs();
    // The diagonal entry is the first of its column.
    for (Index j = 0; j < matrix_.cols(); ++j)
      matrix_.valuePtr()[matrix_.outerIndexPtr()[j]] += mass_[j];
    factors_.factorize(matrix_);
    if (factors_.info() != Eigen::Success) return false;
    flops = bytes = 0;
    const SymmetricMatrix& l = factors_.matrixL().nestedExpression();
    for (Index j = 0; j < l.cols(); ++j) {
      const double rows = l.outerIndexPtr()[j + 1] - l.outerIndexPtr()[j];
      flops += rows * (rows + 2);
      bytes += (sizeof(double) + sizeof(int)) * rows + sizeof(double);
    }
    return true;
  }
  void solve(const Vec& b, Vec& x) override { x = factors_.solve(b); }

 private:
  const Vec& mass_;
  SymmetricMatrix matrix_;
  Eigen::SimplicialLDLT<SymmetricMatrix> factors_;
};

// Let J be the Jacobian of (q, v)' = (v, M^-1 f(q)) and h^2 = s. Then (I - h J) (a, b) = (r, c)
// gives (M - s K) b = M c + h K r.
class KluSolver final : public DirectSolver {
 public:
  explicit KluSolver(const System& system)
      : mass_(system.mass()),
        pattern_(system),
        starts_(pattern_.column_starts().begin(), pattern_.column_starts().end()),
        rows_(pattern_.rows().begin(), pattern_.rows().end()),
        values_(rows_.size()),
        y_(2 * system.size()) {
    klu_l_defaults(&common_);
    symbolic_ = klu_l_analyze(2 * system.size(), starts_.data(), rows_.data(), &common_);
    if (common_.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
    if (!symbolic_) throw std::runtime_error("KLU could not analyse the matrix");
  }
  ~KluSolver() override {
    klu_l_free_numeric(&numeric_, &common_);
    klu_l_free_symbolic(&symbolic_, &common_);
  }
  KluSolver(const KluSolver&) = delete;
  KluSolver& operator=(const KluSolver&) = delete;

  bool factorize(double s, const SymmetricMatrix& k) override {
    const double h = std::sqrt(s);
    pattern_.fill(1, -h, -h * mass_.cwiseInverse(), k, Vec::Ones(mass_.size()), values_.data());
    if (numeric_) {
      return klu_l_refactor(starts_.data(), rows_.data(), values_.data(), symbolic_, numeric_,
                            &common_);
    }
    numeric_ = klu_l_factor(starts_.data(), rows_.data(), values_.data(), symbolic_, &common_);
    if (!numeric_) return false;
    klu_l_flops(symbolic_, numeric_, &common_);
    flops = common_.flops;
    bytes = (sizeof(double) + sizeof(std::int64_t)) *
            static_cast<double>(numeric_->lnz + numeric_->unz + numeric_->nzoff);
    return true;
  }
  void solve(const Vec& b, Vec& x) override {
    const Index n = mass_.size();
    y_ << Vec::Zero(n), b.cwiseQuotient(mass_);
    klu_l_solve(symbolic_, numeric_, 2 * n, 1, y_.data(), &common_);
    x = y_.tail(n);
  }

 private:
  const Vec& mass_;
  FirstOrderPattern pattern_;
  std::vector<SuiteSparse_long> starts_, rows_;
  std::vector<double> values_;
  Vec y_;
  klu_l_common common_{};
  klu_l_symbolic* symbolic_ = nullptr;
  klu_l_numeric* numeric_ = nullptr;
};

template <class Solver, auto... options>
std::unique_ptr<DirectSolver> make(const System& system) {
  return std::make_unique<Solver>(system, options...);
}

}  // namespace

const std::vector<DirectSolverKind>& direct_solvers() {
  using enum Solver;
  static const std::vector<DirectSolverKind> all = {{"multifrontal", make<OwnSolver, multifrontal>},
                                                    {"cholmod", make<OwnSolver, cholmod>},
                                                    {"eigen", make<EigenSolver>},
                                                    {"klu", make<KluSolver>}};
  return all;
}

}  // namespace qddot::solvers
