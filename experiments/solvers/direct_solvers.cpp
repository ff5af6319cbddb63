#include "experiments/solvers/direct_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <stdexcept>

#include <Eigen/SparseCholesky>
#include <suitesparse/klu.h>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/first_order.hpp"

// C = alpha A B + beta C of column-major matrices (Dongarra, Du Croz, Hammarling, Hanson, ACM TOMS
// 14 (1988) 1-17), as Fortran calls it.
extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n,
                       const int* k, const double* alpha, const double* a, const int* lda,
                       const double* b, const int* ldb, const double* beta, double* c,
                       const int* ldc);

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

// The number of calls that take about a millisecond.
template <class Call>
int calls_in_a_sample(const Call& call) {
  return std::clamp(static_cast<int>(1e-3 / seconds_of(call)), 1, 1000);
}

template <class Call>
double time_of(int calls, const Call& call) {
  call();  // reloads the caches after the other solvers
  const double all = seconds_of([&] {
    for (int i = 0; i < calls; ++i) call();
  });
  return all / calls;
}

double known(double x) { return x > 0 ? x : SolverRow::nothing; }

}  // namespace

const std::vector<DirectSolverKind>& direct_solvers() {
  using enum Solver;
  static const std::vector<DirectSolverKind> all = {{"multifrontal", make<OwnSolver, multifrontal>},
                                                    {"cholmod", make<OwnSolver, cholmod>},
                                                    {"eigen", make<EigenSolver>},
                                                    {"klu", make<KluSolver>}};
  return all;
}

double product_flops(double seconds) {
  constexpr int n = 480;  // three of them fit about into the second cache
  constexpr double one = 1, zero = 0;
  const std::vector<double> a(n * n, 0.5), b = a;
  std::vector<double> c(n * n);
  const double least = measure::least_seconds(seconds, [&] {
    dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n);
  });
  return 2.0 * n * n * n / least;
}

Contender::Contender(const DirectSolverKind& kind, const System& system, double s,
                     const SymmetricMatrix& k)
    : s_(s),
      k_(k),
      b_(Vec::LinSpaced(system.size(), -1, 2)),
      x_(b_),
      row_{.unknowns = system.size(), .solver = kind.name} {
  row_.analysis = seconds_of([&] { solver_ = kind.make(system); });
  has_solved_ = solver_->factorize(s, k);
  if (!has_solved_) return;
  solve();
  const SymmetricMatrix whole = k.selfadjointView<Eigen::Lower>();
  const Vec product = system.mass().cwiseProduct(x_) - s * (whole * x_);
  row_.residual = (product - b_).cwiseAbs().maxCoeff();
  factorizations_ = calls_in_a_sample([&] { factorize(); });
  solves_ = calls_in_a_sample([&] { solve(); });
}

std::vector<double> Contender::sample() {
  if (!has_solved_) return {};
  return {time_of(factorizations_, [&] { factorize(); }), time_of(solves_, [&] { solve(); })};
}

void Contender::take(const std::vector<double>& sample) {
  if (sample.empty()) return;
  row_.factorization = std::fmin(row_.factorization, sample[0]);
  row_.solve = std::fmin(row_.solve, sample[1]);
}

SolverRow Contender::row(const std::string& scene) const {
  SolverRow row = row_;
  row.scene = scene;
  row.gflops = known(1e-9 * solver_->flops / row.factorization);
  row.gigabytes_per_second = known(2e-9 * bytes() / row.solve);
  row.bytes = known(bytes());
  return row;
}

}  // namespace qddot::solvers
