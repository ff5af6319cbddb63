#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/model/time_curve.hpp"

// Capabilities: what a System may offer beside V, f and K. Each is an interface. A system class
// derives from System and from the interfaces that it implements, and overrides System's accessor
// of each.

namespace qddot {

// K as the sum of the material stiffness and the geometric stiffness, which tension adds across a
// spring. Compression changes the sign of the second and may make K indefinite. Both functions
// write into `k`, which must have the pattern of System::stiffness_pattern().
class SplitStiffness {
 public:
  virtual ~SplitStiffness() = default;
  // The material stiffness [N/m]: -sum tau' b b' over the springs, b being the gradient of a
  // spring's length. Negative semidefinite at every q.
  virtual void material_stiffness(const At& at, SymmetricMatrix& k) const = 0;
  // K [N/m] with the transverse part tau/l (I - nn') of every compressed spring scaled by the
  // weight. A weight of 1 gives K to the last bit, a weight of 0 a negative semidefinite matrix.
  virtual void weighted_stiffness(const At& at, double compression_weight,
                                  SymmetricMatrix& k) const = 0;
};

// The discrete gradient of V; methods use it to conserve the energy exactly.
class DiscreteGradient {
 public:
  virtual ~DiscreteGradient() = default;
  // Writes the discrete gradient f [N] of V: f.(b - a) = V(a) - V(b) for all a and b, and
  // f = force(a) if b = a. Like a force, it conserves linear and angular momentum. Source:
  // Gonzalez, Journal of Nonlinear Science 6 (1996) 449-467, for each spring by itself. f: n, sized
  // by the caller.
  virtual void mean_force(const At& a, const At& b, MutableVec f) const = 0;
};

// A constant matrix L that replaces -K at every q: f(q) = -L q + r(q). The L of springs is -K with
// all rest lengths and quartic terms set to zero; r is bounded if no spring has a quartic term.
class Laplacian {
 public:
  virtual ~Laplacian() = default;
  // Writes L [N/m] into `l`, which must have the pattern of System::stiffness_pattern(); so only a
  // system with K offers it. No entry couples different axes.
  virtual void assemble_laplacian(SymmetricMatrix& l) const = 0;
  // Whether L bounds the stiffness: x'(-K(q))x <= x'Lx for all q and x.
  virtual bool bounds_stiffness() const = 0;
};

// A region of positions in which f is linear, though it is not linear everywhere. A system without
// this is linear everywhere or nowhere, as System::stiffness_is_constant() says.
class PiecewiseLinear {
 public:
  virtual ~PiecewiseLinear() = default;
  // Whether q (n) lies in that region: f(b) = f(a) + K (b - a) for any a and b in it and for all
  // points between them. q need not lie on a motion.
  virtual bool is_linear_at(const At& at) const = 0;
};

// The positions at which a system has the forces of the scene that it was made from; elsewhere its
// forces are wrong (see Holds in spring.hpp). A system without this capability is valid everywhere.
class Validity {
 public:
  virtual ~Validity() = default;
  // Whether the system is valid at q (n).
  virtual bool is_valid_at(const At& at) const = 0;
  // The time [s] at which the system stops being valid in the step between two states; nothing if
  // it stays valid. Integrators ask after each step and accept only steps that stay valid.
  virtual std::optional<double> end_of_validity(const State&, const State& to) const {
    return is_valid_at(to.q) ? std::nullopt : std::optional(to.t);
  }
};

// Lengths at whose changes of sign the force jumps. Example: a spring of rest length l0 > 0 on a
// line reverses its force k l0 when its length passes through zero. A system without this has a
// continuous force.
class Kinks {
 public:
  virtual ~Kinks() = default;
  // The number of such lengths.
  virtual Index kink_count() const = 0;
  // Writes these signed lengths [m] at q (n) into `lengths`, sized by the caller. They are affine
  // in q.
  virtual void kink_lengths(const At& at, MutableVec lengths) const = 0;
};

// A rate of change by a formula over some instants: x' = a0 x0 + a1 x1 + a2 x2, with a0 + a1 + a2 =
// 0 [1/s], of anything that depends on the positions q0 (n) and those at earlier instants, and on
// their times t [s] if the system is not autonomous.
struct BackwardRate {
  ConstVec q0, q1, q2;
  double a0, a1, a2;
  double t0 = 0, t1 = 0, t2 = 0;
  const Phase* phases = nullptr;  // see At
};

// Damping that is linear in the velocities: f(q, v) = -dV/dq - C(q) v. Rayleigh's dissipation
// function R = 1/2 v'Cv gives it by Lagrange's equation,
//   d/dt dL/dv - dL/dq = -dR/dv.
// So C is symmetric and positive semidefinite, and the energy falls at the rate v'Cv = 2R. The
// force of such a system has both parts. Where it is given no velocities, it is -dV/dq alone.
class Damping {
 public:
  virtual ~Damping() = default;
  // Writes f_d = -C(q) v [N] into `f`; q, v, f: n.
  virtual void friction(const At& at, MutableVec f) const = 0;
  // Writes f(q) + f_d into `f` and f_d into `friction` in one pass, with work beside it if `beside`
  // is not nullptr. Returns the sum of that work, see System::force_beside; or nothing, and does
  // nothing, if the system has no such pass.
  virtual std::optional<double> damped_force(const At& /*at*/, MutableVec /*f*/,
                                             MutableVec /*friction*/,
                                             BesideForce* /*beside*/) const {
    return {};
  }
  // Writes friction at q0 into `f`, with the rates l' of the dashpots' lengths by the formula in
  // place of those by velocities, and returns the power that it takes [W]. So a dashpot is a
  // spring: its force is -(1/a0) d(c l'^2 / 2)/d q0, and its power c l'^2. Air is by the velocities
  // v (n). Returns nothing, and does nothing, if the system has no dashpots or knows no lengths.
  virtual std::optional<double> secant_friction(const BackwardRate& /*rate*/, const ConstVec& /*v*/,
                                                MutableVec /*f*/) const {
    return {};
  }
  // Writes C(q) [N s/m] into `c`, which must have the pattern of System::stiffness_pattern().
  virtual void damping_matrix(const At& at, SymmetricMatrix& c) const = 0;
  // Whether C is the same at every q.
  virtual bool damping_is_constant() const = 0;
  // Writes a constant matrix that bounds C everywhere, x'C(q)x <= x'Lx, and couples no different
  // axes (as Laplacian does), into `l`, and returns true. Returns false if the system has none.
  virtual bool bound_damping(SymmetricMatrix& /*l*/) const { return false; }
  // alpha [1/s] of the air, and whether there is anything else: if not, C = alpha M.
  virtual double air_damping() const { return 0; }
  virtual bool has_dashpots() const { return true; }
  // beta [s], if C = alpha M - beta (SplitStiffness::material_stiffness) everywhere.
  virtual std::optional<double> damping_time() const { return {}; }
};

// The forces of a linear system as functions of time, f(q, s) - K q + C v: harmonics
// a sin(w s + phi), and a polynomial from the time t on, sum_k derivatives_k (s - t)^k/k!.
struct Forcing {
  struct Harmonic {
    double frequency, phase;  // w [rad/s], phi [rad]
    Vec amplitude;            // [N], n
  };
  std::vector<Harmonic> harmonics{};
  std::vector<Vec> derivatives{};  // [N/s^k], n each
};

// Supports that move and loads that change: V depends on t, and f = -dV/dq at each time. The energy
// changes at the rate dV/dt at constant q,
//   d/dt (T + V) = dV/dt - v'Cv,
// as Noether's theorem has it. A support that moves against dashpots also does the work that they
// take of it.
class Driving {
 public:
  virtual ~Driving() = default;
  // The rates [W] of the energy that driving gives, dV/dt and what supports give to dashpots, and
  // of what dashpots take of supports. Without velocities, the latter is left out. Damping books
  // -v'f_d; the sum of both is what damping takes.
  virtual Work driving_power(const At& at) const = 0;
  // The change of V [J] from one time to another at constant q and phases, those of `at`.
  virtual double potential_change(double from, double to, const At& at) const = 0;
  // Writes df/dt [N/s] at constant q, for conservative forces and air, into `rate` (n).
  virtual void force_rate(const At& at, MutableVec rate) const = 0;
  // The corners of f(t) at constant q and v, ascending in time.
  virtual std::vector<Corner> corners() const = 0;
  // The forces of a system of constant K from the time t to the next corner; nothing if they are no
  // such sums.
  virtual std::optional<Forcing> forcing(double /*t*/) const { return {}; }
};

// Springs that go slack or break: f and V are smooth as long as all springs stay in their phases,
// and a spring's length decides when its phase ends. Each such spring has a number, 0, 1, ...; the
// phases of all are in At::phases and State::phases by these numbers.
class Switching {
 public:
  virtual ~Switching() = default;
  // The end of a spring's phase, and the next one.
  struct Change {
    double t = 0;  // [s]
    int number = 0;
    Phase to = Phase::by_length;
  };
  // The springs that have changed their phases in a run. The places after that have the error
  // `allowance` of an adaptive method [m], so that one is not believed to change back up to that.
  struct Changed {
    std::span<const char> has_changed;
    double allowance = 0;
  };
  // How far a spring's length is from the end of its phase [m], its rate [m/s], and its rounding.
  struct Margin {
    double length, rate, rounding;
  };
  virtual Index phase_count() const = 0;
  // The number k of the derivative of f that jumps where a cable goes slack or taut: 0 if it has a
  // dashpot, else 1; nothing if no spring does.
  virtual std::optional<int> order_of_slack() const = 0;
  // Sets the phases at `at`, which has velocities, of all springs that are not broken in `phases`:
  // by_length, or that of each cable if `finds_slack`.
  virtual void set_phases(const At& at, bool finds_slack, std::span<Phase> phases) const = 0;
  // The first change in the step between two states from these phases on; nothing if there is none.
  // A spring that may come to the end of its phase and back in a long step counts as well.
  // In the step each spring follows the cubic that has its ends' places and velocities.
  virtual std::optional<Change> first_change(const State& from, const State& to,
                                             std::span<const Phase> phases,
                                             const Changed& changed) const = 0;
  // The margin from the change of spring `number` to a phase; at `at`, which has velocities.
  virtual Margin margin(const At& at, int number, Phase to) const = 0;
  // Appends the changes that are due at `at` for spring after spring, within rounding.
  virtual void add_due_changes(const At& at, std::span<const Phase> phases,
                               std::vector<Change>& due) const = 0;
  // The energy V [J] and the strain (l - l0)/l0 of a spring that is not broken.
  virtual double energy_of(const At& at, int number) const = 0;
  virtual double strain_of(const At& at, int number) const = 0;
};

// G = dg/dq: m x n, row by row.
using GradientMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// Constraints g(t, q) = 0, such as the lengths of rods, which forces along their gradients keep:
//   M q'' = f - G'lambda,   g(t, q) = 0,   G = dg/dq (m x n)
// The functions g are quadratic in q, so that G is linear. At g = 0, G has independent rows, and a
// motion obeys G v + dg/dt = 0 as well. Source: Hairer, Lubich, Wanner, Geometric Numerical
// Integration (2006), VII.1. f and V are those without constraints.
class Constraints {
 public:
  virtual ~Constraints() = default;
  // d2g_k/dq_i dq_j, i >= j [1/m].
  struct Curvature {
    Index k, i, j;
    double value;
  };
  // The number m.
  virtual Index constraint_count() const = 0;
  // Writes g [m] into `g` (m).
  virtual void constraint_values(const At& at, MutableVec g) const = 0;
  // The pattern of G, with zero values.
  virtual const GradientMatrix& gradient_pattern() const = 0;
  // Writes G into `gradients`, which must have that pattern.
  virtual void constraint_gradients(const At& at, GradientMatrix& gradients) const = 0;
  // The same for dG/dt along the motion, at velocities [1/s].
  virtual void gradient_rates(const At& at, GradientMatrix& rates) const = 0;
  // Writes dg/dt at constant q [m/s], which moving supports cause, into `rates` (m).
  virtual void constraint_rates(const At& at, MutableVec rates) const = 0;
  // Writes g'' along a motion with q'' = 0 [m/s^2], at velocities, into `accelerations` (m).
  virtual void constraint_accelerations(const At& at, MutableVec accelerations) const = 0;
  // The second derivatives of g that are not zero.
  virtual std::vector<Curvature> curvatures() const = 0;
  // c [m/N], m, if g = c lambda in place of g = 0: springs of stiffness 1/c along the gradients
  // that stretch at once, and do not vibrate. Empty if all c are zero. Only RATTLE heeds it.
  virtual const Vec& compliances() const = 0;
};

// A system that implements all capabilities above but Constraints. Its accessors say which of them
// it has.
class CapableSystem : public System,
                      public SplitStiffness,
                      public DiscreteGradient,
                      public Laplacian,
                      public PiecewiseLinear,
                      public Validity,
                      public Kinks,
                      public Damping,
                      public Driving,
                      public Switching {
 public:
  using System::System;
};

// A system divided in two: f = stiff->force + soft->force, and V and K are sums likewise. Both have
// all unknowns and masses of the whole, which is valid where both are valid. Each K has the pattern
// of its own forces alone, and exists if the whole has K. The soft system of a network holds
// weight, loads and constants; either may have no springs.
struct Split {
  std::shared_ptr<const System> stiff, soft;
  // The stiff system over only those unknowns that stiff forces act on: unknown a of `stiff_block`
  // is unknown stiff_unknowns[a] of the whole, ascending.
  std::shared_ptr<const System> stiff_block;
  std::vector<Index> stiff_unknowns;
};

}  // namespace qddot
