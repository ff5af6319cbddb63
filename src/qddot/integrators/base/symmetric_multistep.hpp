#pragma once

#include <memory>
#include <vector>

#include "qddot/integrators/base/deferred_correction.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/base/symmetric_formula.hpp"

namespace qddot {

// Steps by a symmetric multistep formula, in sums (Henrici, Discrete Variable Methods in Ordinary
// Differential Equations, 1962, chapter 6). Let d_n = q_n - q_{n-1} and r_0 = 1. Then
//   u_n = h^2 g_n - (r_1 u_{n-1} + ... + r_{k-2} u_{n-k+2}),
//   d_{n+1} = d_n + beta_{k-1} u_n + beta_{k-2} u_{n-1} + ... + beta_1 u_{n-k+2},
//   q_{n+1} = q_n + d_{n+1},
// which rounds d, not differences of q. One force a step. The first k - 1 steps are computed
// together, by k/2 sweeps of deferred correction: k/2 (k - 1) forces. A Nystrom pair takes a last
// step of another length and steps to times between steps. Velocities are computed only when they
// are asked for.
class SymmetricMultistep final : public Formula {
 public:
  struct X : State {
    Vec d, f;                   // the last difference; the force at q
    Index begun = 0;            // steps since the start, k - 1 at most
    std::ptrdiff_t newest = 0;  // the place in the history of the next u
    bool has_history = false;   // whether k - 1 steps are taken
    bool has_force = false;     // whether f is known
    bool has_velocity = false;  // whether v is known
  };

  SymmetricMultistep(SystemRun& run, const SymmetricFormula& formula);

  void begin(const State& state, X& x);
  Outcome step(X& x, double h, X& next);
  void show(X& x, bool may_evaluate, State& state);
  double squared_speed(const X& next);

  const SymmetricFormula& table() const { return formula_; }

 private:
  void single_step(X& x, double h, X& next);
  // Computes the first k - 1 steps.
  void begin_from(X& x);
  // Begins the history after them.
  void begin_history(X& x);
  void evaluate(X& x);
  Work work_of_step(Index j) const;
  // u of so many steps before x: 1 is that of the last step.
  Vec& u(const X& x, std::ptrdiff_t ago) {
    return u_[static_cast<std::size_t>((x.newest + ago) % std::ssize(u_))];
  }

  const SymmetricFormula& formula_;
  std::vector<double> r_, b_;                 // r_0 ... r_{k-2}; beta_{k-1} ... beta_1
  std::vector<double> with_force_, without_;  // weights of g_N and u_{N-1}, ... in h v_N
  SymmetricStart symmetric_start_;
  NystromStages stages_;
  Vec h2_by_mass_;
  double h_ = 0;  // of all steps but the last [s]
  DeferredCorrection first_;
  StepIntegrals integrals_;
  std::vector<Work> powers_;  // of driving at the ends of the last steps, if anything is driven
  std::vector<Vec> u_;        // a ring buffer, with a place for the next
  Vec f_, a_;
  State state_;
  std::vector<const double*> past_;
  std::vector<double> weights_;
};

// Makes the stepper of Method::symmetric_formula; for Method::make.
std::unique_ptr<Stepper> create_symmetric(SystemRun& run);
// The roots of a formula; for Method::recurrence_roots.
template <const SymmetricFormula& (*formula)()>
std::vector<std::complex<double>> symmetric_roots(double h_omega, double /*zeta*/) {
  return roots_of(formula(), h_omega);
}

}  // namespace qddot
