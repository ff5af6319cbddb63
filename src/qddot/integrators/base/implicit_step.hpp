#pragma once

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/integrators/base/compression.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {

// A fixed step with implicit stages. Whatever the formula, a stage of M q'' = f(q) solves
//   M (u - u*) = s f(q_n + u)
// for the displacement u from q_n, with known u* and s [s^2]. Its solution makes the incremental
// potential
//   g(u) = 1/2 (u - u*)' M (u - u*) + s V(q_n + u)
// stationary, and a minimum is sought (Martin, Thomaszewski, Grinspun, Gross, SIGGRAPH 2011,
// section 4). The acceleration of the stage is (u - u*)/s: it costs no force.
//
// Newton's method uses the last factors of M - s K as long as it converges, and else a new K. Only
// a part of the compression is kept if M - s K is not positive definite (see compression.hpp). So
// directions descend, and a step that does not decrease g is halved until it does. A system without
// V has no g, and its steps are whole.
//
// If the system has Damping, f is that at the velocity of the stage, which is linear in u:
//   v = r u + w,   with r [1/s] and w of the formula.
// Then Newton's matrix is M - s (K - r C), and g has the term s/(2 r) v'Cv, with C as it is where a
// step along a direction begins.
class ImplicitStep : public Formula {
 public:
  // Default parts of a prediction's error that a stage's solve leaves. Less gains nothing for most
  // methods, but invariants are conserved only as well as stages are solved.
  static constexpr double usual_tolerance = 1e-4, tolerance_for_invariants = 1e-9;

  // `solve_tolerance`: used if the options give none.
  explicit ImplicitStep(SystemRun& run, double solve_tolerance = usual_tolerance);
  virtual ~ImplicitStep() = default;

  // Forgets all factors; a method that hides this calls it.
  void begin(const State& state, State& x);

 protected:
  // Solves the stage at q = q_n and time t [s] for u_, which holds its prediction, with u* in
  // free_. The remaining error is the tolerance times the prediction's error, which is of the size
  // of the step's own error. Returns reached_end, newton_failed, indefinite_matrix, not_finite or
  // over_budget.
  Outcome solve_stage(const Vec& q, double t, double s);
  // Sets v = r u + w of the next stages; for systems with Damping. w is zero if it is left out.
  void set_velocity(double r) {
    rate_ = r;
    w_.setZero();
  }
  template <class Expression>
  void set_velocity(double r, const Eigen::MatrixBase<Expression>& w) {
    rate_ = r;
    w_ = w;
  }
  // Has the next stages take dashpots as springs within the step: by the rates of their lengths
  // a0 l(q_n + u) + a1 l_1 + a2 l_2, with a0 = r of set_velocity(), if the system knows lengths.
  // Then friction has a potential, and does not resist a turn of the whole. The states of l_1 and
  // l_2 must outlive the stages.
  void set_lengths(double a1, const State& at1, double a2, const State& at2) {
    at1_ = &at1, at2_ = &at2, a1_ = a1, a2_ = a2;
  }
  // The power [W] of friction and driving at the last stage.
  Work stage_power(const Vec& q);
  // The time of the stage [s].
  double stage_time() const { return t_; }

  // a = M^-1 f [m/s^2]; for methods that begin with it.
  void acceleration(const At& at, Vec& a);

  Vec free_, u_;  // u* and u

 private:
  // A stage's f and K; overridden by methods with another mean of the forces over the step.
  virtual void stage_force(const Vec& q, const Vec& u, Vec& f);
  virtual void stage_stiffness(const Vec& q, const Vec& u, double compression_weight,
                               SymmetricMatrix& k);
  // Whether a stage's f is the gradient of a potential, so that g exists.
  virtual bool is_minimisation() const { return true; }
  // The part of u at which a stage's f takes friction.
  virtual double friction_part() const { return 1; }
  // Whether a stage's f uses forces at q itself, which then have to be linear as well.
  virtual bool knows_start() const { return false; }

  struct Iteration;
  Outcome correct(const Vec& q, double s, Iteration& now);
  double rate_of(const Iteration& now, const Vec& q, double size, bool is_first);
  bool is_exact(const Vec& q);
  bool is_rounding(const Vec& q, double size, double least) const;
  bool is_linear_along(const Vec& q);
  // Whether f has a kink (Kinks) between q, the place of the residual and the place that the
  // correction leads to.
  bool crosses_kink(const Vec& q);
  void residual(const Vec& q, double s);
  // Factorises with up to twice the compression of the last factors, or with less if that fails.
  Outcome factorize(const Vec& q, double s);
  Outcome factorize_softened(const Vec& q, double s);
  // May also return indefinite_matrix: conjugate gradients detect it only while solving.
  Outcome correction();
  double search(const Vec& q, double s);
  double objective(const Vec& q, double s);
  // The stage's place and velocity in x_ and velocity_, as the arguments of friction.
  At at_friction(const Vec& q);
  // Friction at x_ and velocity_, with the dashpots as springs, in secant_, and its power; nothing
  // if there are no lengths to go by.
  std::optional<double> find_secant_friction();

  const double tolerance_;
  double t_ = 0;                   // of the stage [s]
  const Kinks* kinks_;             // nullptr if f has no kinks
  const PiecewiseLinear* pieces_;  // nullptr if a constant K implies a linear f
  Vec x_, f_, r_, p_, before_, start_, length_, other_length_;
  SymmetricMatrix k_;
  EffectiveMass matrix_;
  double factorized_s_ = 0;  // s of the present factors; 0: none
  const bool is_damped_;
  double rate_ = 0, factorized_rate_ = 0;        // r, and that of the present factors
  Vec w_, velocity_;                             // n if the system has Damping
  const State *at1_ = nullptr, *at2_ = nullptr;  // see set_lengths
  double a1_ = 0, a2_ = 0;
  Vec secant_;
  Vec frozen_;               // where C of g is taken
  Compression compression_;  // of the present factors
  // The error of the last stage's prediction, and the rate of convergence of its corrections.
  double last_missed_ = 0, last_rate_ = 1;
};

}  // namespace qddot
