#include "qddot/algebra/automatic_factors.hpp"

#include <unistd.h>

#include "qddot/algebra/conjugate_gradients.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"

namespace qddot {
namespace {

// Operations of a factorisation that take as long as an iterative method's reading of memory: per
// entry of L for a solve, which reads it twice, and per entry of the triangle for an iteration.
// Measured on lattices and cloths of 4000 to 30,000 unknowns, at 60 Gflop/s.
constexpr double per_factor_entry = 30, per_matrix_entry = 22;
// The work, in iterations, up to which a factorisation leaves little to gain. Then all is
// multifrontal, and exact to rounding.
constexpr double fewest_iterations = 300;
// Hysteresis: conjugate gradients are left as soon as they cost more. They are used again only if
// they cost half as much when last used, which may be long ago.
constexpr double share_to_return = 0.5;

struct FactorWork {
  double factorization = 0, iteration = 0;  // operations
  double entries = 0;                       // of L

  FactorWork(const SymbolicFactorization& symbolic, const SymmetricMatrix& pattern)
      : factorization(symbolic.operations()),
        iteration(per_matrix_entry * static_cast<double>(pattern.nonZeros())),
        entries(symbolic.entries()) {}
};

double memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

class AutomaticFactors final : public Factors {
 public:
  AutomaticFactors(const SymmetricMatrix& pattern, Vec diagonal, SymbolicFactorization symbolic,
                   const FactorWork& work)
      : pattern_(pattern),
        diagonal_(std::move(diagonal)),
        symbolic_(std::move(symbolic)),
        work_(work),
        fits_(sizeof(double) * work.entries < memory() / 2),
        iterative_(make_conjugate_gradients(pattern, diagonal_)) {}

  Definiteness factorize(double a, double s, const SymmetricMatrix& k) override {
    begin(a, s, k, false);
    if (is_direct_) return direct_->factorize(a, s, k);
    const Definiteness found = iterative_->factorize(a, s, k);
    return found == Definiteness::positive || !fits_ ? found : take_direct();
  }

  bool factorize_positive(double a, double s, const SymmetricMatrix& k) override {
    begin(a, s, k, true);
    return is_direct_ ? direct_->factorize_positive(a, s, k)
                      : iterative_->factorize_positive(a, s, k);
  }

  Index negative_pivots() const override {
    return is_direct_ ? direct_->negative_pivots() : iterative_->negative_pivots();
  }

  Index bytes() const override { return iterative_->bytes() + (direct_ ? direct_->bytes() : 0); }

  void set_tolerance(double tolerance) override { iterative_->set_tolerance(tolerance); }

  SolveOutcome solve(const Vec& b, Vec& x) override { return solve_with(b, x); }
  SolveOutcome solve(const FourColumns& b, FourColumns& x) override { return solve_with(b, x); }

 private:
  // Begins another matrix. It is solved with in the way that was the cheaper one for the last
  // matrix.
  void begin(double a, double s, const SymmetricMatrix& k, bool only_positive) {
    if (solves_ > 0 && fits_) {
      if (iterated_solves_ > 0) last_rate_ = iterated_ / iterated_solves_;
      const double iterations = last_rate_ * solves_ * work_.iteration;
      const double direct = work_.factorization + solves_ * work_.entries * per_factor_entry;
      prefers_direct_ = iterations > (prefers_direct_ ? share_to_return : 1) * direct;
    }
    a_ = a;
    s_ = s;
    k_ = &k;
    only_positive_ = only_positive;
    solves_ = iterated_ = iterated_solves_ = 0;
    is_direct_ = prefers_direct_;
    if (is_direct_) make_direct();
  }

  template <class Columns>
  SolveOutcome solve_with(const Columns& b, Columns& x) {
    solves_ += static_cast<double>(b.cols());
    const bool is_paid = iterated_ * work_.iteration > work_.factorization;
    if (!is_direct_ && !(is_paid && fits_)) {
      const auto before = iterative_->iterations();
      const SolveOutcome solution = iterative_->solve(b, x);
      iterated_ += static_cast<double>(iterative_->iterations() - before);
      iterated_solves_ += static_cast<double>(b.cols());
      const bool is_of_no_use = solution == SolveOutcome::indefinite && only_positive_;
      if (solution == SolveOutcome::found || is_of_no_use || !fits_) return solution;
    }
    if (!is_direct_) {
      const Definiteness found = take_direct();
      if (found == Definiteness::singular) return SolveOutcome::indefinite;
      if (found == Definiteness::indefinite && only_positive_) return SolveOutcome::indefinite;
    }
    return direct_->solve(b, x);
  }

  // Factorises the present matrix, which was solved with by conjugate gradients so far.
  Definiteness take_direct() {
    make_direct();
    is_direct_ = true;
    if (!only_positive_) return direct_->factorize(a_, s_, *k_);
    return direct_->factorize_positive(a_, s_, *k_) ? Definiteness::positive
                                                    : Definiteness::indefinite;
  }

  void make_direct() {
    if (!direct_) direct_ = make_multifrontal(pattern_, diagonal_, std::move(symbolic_));
  }

  const SymmetricMatrix pattern_;
  const Vec diagonal_;
  SymbolicFactorization symbolic_;  // until direct_ is made from it
  const FactorWork work_;
  const bool fits_;  // whether L fits into memory
  std::unique_ptr<IterativeFactors> iterative_;
  std::unique_ptr<Factors> direct_;  // empty until it is needed

  bool prefers_direct_ = false;
  double last_rate_ = 0;  // iterations of a solve
  // The present matrix: the way of its solves, their number, and their iterations.
  bool is_direct_ = false, only_positive_ = false;
  double a_ = 0, s_ = 0;
  const SymmetricMatrix* k_ = nullptr;
  double solves_ = 0, iterated_ = 0, iterated_solves_ = 0;
};

}  // namespace

std::unique_ptr<Factors> make_automatic_factors(const SymmetricMatrix& pattern, Vec diagonal) {
  SymbolicFactorization symbolic = analyse(pattern);
  const FactorWork work(symbolic, pattern);
  if (work.factorization < fewest_iterations * work.iteration)
    return make_multifrontal(pattern, std::move(diagonal), std::move(symbolic));
  return std::make_unique<AutomaticFactors>(pattern, std::move(diagonal), std::move(symbolic),
                                            work);
}

}  // namespace qddot
