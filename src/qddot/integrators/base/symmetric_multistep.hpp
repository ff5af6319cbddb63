#pragma once

#include <memory>
#include <vector>

#include "qddot/integrators/base/deferred_correction.hpp"
#include "qddot/integrators/base/fixed_step.hpp"
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
class SymmetricMultistep final : public FixedStep {
 public:
  SymmetricMultistep(const Method& method, const System& system, const Options& options,
                     const SymmetricFormula& formula);

  const SymmetricFormula& table() const { return formula_; }

 private:
  void start(const State& state) override;
  Outcome step(const State& now, double h, State& next) override;
  void accepted() override;
  void complete(State& now, bool may_evaluate) override;
  double squared_speed(const State& next) override;

  void single_step(const State& now, double h, State& next);
  // Computes the first k - 1 steps.
  void begin_from(const State& now);
  // Begins the history after them.
  void begin_history();
  void evaluate(const Vec& q);
  // u of so many steps ago: 1 is that of the last step.
  Vec& u(std::ptrdiff_t ago) {
    return u_[static_cast<std::size_t>((newest_ + ago) % std::ssize(u_))];
  }

  const SymmetricFormula& formula_;
  std::vector<double> r_, b_;                 // r_0 ... r_{k-2}; beta_{k-1} ... beta_1
  std::vector<double> with_force_, without_;  // weights of g_N and u_{N-1}, ... in h v_N
  SymmetricStart symmetric_start_;
  NystromStages stages_;
  Vec h2_by_mass_;
  double h_ = 0;  // of all steps but the last [s]
  DeferredCorrection first_;
  Index begun_ = 0;            // steps since the start, k - 1 at most
  std::vector<Vec> u_;         // a ring buffer, with a place for the next
  std::ptrdiff_t newest_ = 0;  // the place of the next
  Vec d_, d_next_, f_, a_;
  bool force_is_known_ = false;  // whether f_ is the force at the history's last q
  bool has_history_ = false;
  std::vector<const double*> past_;
  std::vector<double> weights_;
};

// Makes the integrator of a formula; for Method::make.
template <const SymmetricFormula& (*formula)()>
std::unique_ptr<Integrator> create_symmetric(const Method& method, const System& system,
                                             const Options& options) {
  return std::make_unique<SymmetricMultistep>(method, system, options, formula());
}
// The roots of a formula; for Method::recurrence_roots.
template <const SymmetricFormula& (*formula)()>
std::vector<std::complex<double>> symmetric_roots(double h_omega) {
  return roots_of(formula(), h_omega);
}

}  // namespace qddot
