// Newton's equations of a second-order system, 2n x 2n, from one symmetric n x n matrix.
//   (I - gamma J)(a, b) = (r, s):                a - gamma b = r,   b - gamma M^-1 K a = s
// The first row gives b = (a - r)/gamma; M gamma times the second is then
//   (M - gamma^2 K) a = M (r + gamma s).
// The implicit form, c = 1/gamma, is             c a - b = r,   c M b - K a = s
//   (M - gamma^2 K) a = gamma (M r + gamma s),   b = c a - r;
// but the first row of an unknown without mass is -b = r. No product with K is needed, so the
// factors may belong to another gamma or an older K than the step at hand. Newton's iteration then
// takes a few more rounds.
//
// With damping, b + gamma M^-1 C b - gamma M^-1 K a = s gives
//   (M + gamma C - gamma^2 K) a = M (r + gamma s) + gamma C r,
// and c M b + C b - K a = s the right side gamma (M r + gamma s) + gamma^2 C r.
#include "integrators/sundials/newton_matrix.hpp"
#include "qddot/algebra/effective_mass.hpp"

namespace qddot::sundials {
namespace {

// LDL' of an indefinite matrix is made without pivoting and may lose any number of digits; Newton's
// iteration makes up for half of them.
constexpr double largest_residual = 1e-8;

class Structured final : public NewtonMatrix {
 public:
  Structured(const System& system, SUNContext context, Solver solver)
      : NewtonMatrix(context), mass_(system.mass()), factors_(system, solver), b_(system.size()) {}

 private:
  void set_explicit_form(double gamma, const SymmetricMatrix& k,
                         const SymmetricMatrix* damping) override {
    is_implicit_ = false;
    set(gamma, k, damping);
  }
  void set_implicit_form(double c, const SymmetricMatrix& k,
                         const SymmetricMatrix* damping) override {
    is_implicit_ = true;
    set(1 / c, k, damping);
  }
  void set(double gamma, const SymmetricMatrix& k, const SymmetricMatrix* damping) {
    gamma_ = gamma;
    k_ = &k;
    damping_ = damping;
  }

  int factorize() override {
    if (damping_) {
      damped_ = *k_;
      damped_.coeffs() -= damping_->coeffs() / gamma_;
      k_ = &damped_;
    }
    definiteness_ = factors_.factorize(1, gamma_ * gamma_, *k_);
    if (definiteness_ == EffectiveMass::Definiteness::singular) return 1;
    if (definiteness_ == EffectiveMass::Definiteness::indefinite) count_indefinite();
    return 0;
  }

  int solve(N_Vector right, N_Vector x) override {
    const Halves rs(right);
    Halves ab(x);
    if (is_implicit_) {
      b_ = gamma_ * (mass_.cwiseProduct(rs.q) + gamma_ * rs.v);
    } else {
      b_ = mass_.cwiseProduct(rs.q + gamma_ * rs.v);
    }
    if (damping_) {
      scaled_ = (is_implicit_ ? gamma_ * gamma_ : gamma_) * rs.q;
      b_.noalias() += damping_->selfadjointView<Eigen::Lower>() * scaled_;
    }
    if (factors_.solve(b_, a_) != SolveOutcome::found) return 1;
    if (definiteness_ == EffectiveMass::Definiteness::indefinite && !is_solved()) return 1;
    if (is_implicit_) {
      ab.v = (mass_.array() > 0).select(a_ / gamma_ - rs.q, -rs.q);
    } else {
      ab.v = (a_ - rs.q) / gamma_;
    }
    ab.q = a_;
    if (has_work(x)) work(x) = (is_implicit_ ? gamma_ : 1) * work(right);
    return 0;
  }

  // Whether (M - gamma^2 K) a = b, with K as it was factorised, to the digits that are needed, if
  // need be after one refinement.
  bool is_solved() {
    for (int refinements = 0;; ++refinements) {
      residual_ = b_ - mass_.cwiseProduct(a_);
      scaled_ = gamma_ * gamma_ * a_;
      residual_.noalias() += k_->selfadjointView<Eigen::Lower>() * scaled_;
      if (residual_.norm() <= largest_residual * b_.norm()) return true;
      if (refinements == 1) return false;
      if (factors_.solve(residual_, correction_) != SolveOutcome::found) return false;
      a_ += correction_;
    }
  }

  const Vec& mass_;
  EffectiveMass factors_;
  EffectiveMass::Definiteness definiteness_ = EffectiveMass::Definiteness::singular;
  const SymmetricMatrix *k_ = nullptr, *damping_ = nullptr;
  SymmetricMatrix damped_;  // K - C/gamma
  double gamma_ = 0;
  bool is_implicit_ = false;
  Vec b_, a_, scaled_, residual_, correction_;
};

}  // namespace

std::unique_ptr<NewtonMatrix> make_structured(const System& system, SUNContext context,
                                              Solver solver) {
  return std::make_unique<Structured>(system, context, solver);
}

}  // namespace qddot::sundials
