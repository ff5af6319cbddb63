#pragma once

#include "qddot/algebra/multipliers.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/base/kick_drift.hpp"

namespace qddot {

// Steps of velocity Verlet of the sizes s = gamma_i h that keep constraints g(t, q) = 0 (RATTLE):
//   v+ = v + s/2 M^-1 (f(q) - G(q)'lambda)
//   q' = q + s v+                          with lambda such that g(q') = 0
//   v' = v+ + s/2 M^-1 (f(q') - G(q')'mu)  with mu such that G(q') v' + dg/dt = 0
// Source: Andersen, J. Computational Physics 52 (1983) 24-34; Hairer, Lubich, Wanner, Geometric
// Numerical Integration (2006), VII.1.4. The step is symmetric, and symplectic on the manifold of
// the constraints. So compositions of it have the orders of those of Verlet. Positions are those of
// SHAKE (Ryckaert, Ciccotti, Berendsen, J. Computational Physics 23 (1977) 327-341), which lacks
// the second projection.
//
// lambda is found by Newton's method with the symmetric matrix A = G(q) M^-1 G(q)' in place of
// G(q') M^-1 G(q)', until g is zero up to rounding. The same factors give mu before.
//
// Damping: air scales v in each drift (see KickDrift). Dashpots, which order 2 alone takes, act at
// the predicted velocity 2 v+ - v (see verlet). Driving: an impulse of lambda gives the work
// lambda' dg/dt beside that of kicks, so that the balance of energy stays bounded.
class RattleSteps final : public Formula {
 public:
  struct X : State {
    Vec f, friction;  // at q; the latter with dashpots alone
    Vec mu;           // of the last stage [N]
    Vec change;       // lambda of the last stage less mu before it [N], and
    double size = 1;  // s of that stage [s]
    Work driving;     // its power where f is
  };

  // `splitting`: a composition of Verlet steps, of the sizes of its drifts.
  RattleSteps(SystemRun& run, const Splitting& splitting);

  void begin(const State& state, X& x);
  Outcome step(const X& now, double h, X& next);
  void show(const X& x, bool, State& state) const;

 private:
  // A Verlet step of the size s [s] from the time t, where A is factorised at next.q.
  Outcome stage(double t, double s, X& next);
  // The drift of it, with the impulse of lambda before.
  Outcome drift(double t, double s, X& next);
  // The second kick of it, at the time t, and the projection of v.
  Outcome kick_along_constraints(double t, double s, X& next);
  void add_work_of_impulse(double s, const Vec& impulse, X& next) const;
  // Factorises A at a place; false if it is singular there.
  bool factorize_at(double t, const Vec& q);
  Outcome no_solution(double t);
  At place(double t, const Vec& q) const { return run_.counted().placed({t, q}); }

  const Splitting& splitting_;
  const Constraints* constraints_;  // nullptr if there are none
  bool has_dashpots_;
  double air_damping_;  // alpha [1/s] of drifts
  Multipliers multipliers_;
  double time_of_factors_ = 0;  // [s], where A is factorised; NaN if it is singular there
  Vec lambda_, g_, solved_;     // m
  Vec rates_, before_, half_;   // dg/dt [m/s]; v at the start and in the middle of a stage
};

// Makes the stepper of a composition of RATTLE steps from Method::splitting; for Method::make.
std::unique_ptr<Stepper> create_rattle(SystemRun& run);

}  // namespace qddot
