// The midpoint rule made linear in the stiff springs, linear_midpoint:
//   x       = q_n + h/2 v_n
//   v_{n+1} = v_n + h A^-1 f(x),   A = M - h^2/4 K_m(x)
//   q_{n+1} = x + h/2 v_{n+1}
// K_m is the material part of the stiffness: how springs resist a change of their lengths, without
// what their tension adds across them. It is that of the stiff springs where the scene names some
// (stiff_above), else that of all springs. A system that does not know its material part gives K.
//
// A step takes one force, one factorisation and one solve, and no iteration. A is positive
// definite, whatever is compressed. Seen from either end of a step x is the same point, so the
// method is time-reversible and has order 2. A^-1 f is no gradient, so it is not symplectic. It
// keeps angular momentum, since springs push along themselves in K_m as in f (where their rest
// length is positive).
//
// If K is constant, this is the implicit midpoint rule for the stiff springs. Let a vibration
// q'' = -(w_f^2 + w_s^2) q have w_f from stiff springs and w_s from soft ones. Then half the trace
// of a step is
//   1 - h^2 (w_f^2 + w_s^2)/(2 + h^2 w_f^2/2)
// So a step is stable for h w_s < 2 at every w_f, without resonances. For h w_f >> 1 vibrations
// along stiff springs keep their size and lose their phase.
//
// linear_midpoint4 composes five such steps, one of them back in time, to order 4 (Suzuki):
//   p h,   p h,   (1 - 4 p) h,   p h,   p h,   p = 1/(4 - 4^(1/3))
// Soft springs disturb it in narrow bands of h, where the five steps together turn a stiff
// vibration by a multiple of pi. Such a vibration grows slowly.
//
// Friction -C v is linear in v, so the midpoint rule for it needs no iteration either:
//   (A + h/2 C(x)) (v_{n+1} - v_n) = h (f(x) - C(x) v_n)
// Then every spring is in the matrix. A step takes the energy h v'Cv of the mean velocity v.
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// An implicit midpoint step is v' = v + h M^-1 f(q_mid) with q_mid = q + h/4 (v + v'). The velocity
// at the start leads to x, and q_mid is x + h/4 (v' - v). If f is linear between x and q_mid, this
// is A (v' - v) = h f(x).
//
// Motion across stiff springs does not depend on their stiffness k. At x they are too long by
// O(h^2), and k enters f and A alike. This leaves a displacement of O(h^2), and rods in the limit.
// A has no tension: that would add h^2 k O(h^2) to the mass across the springs, which with the
// other sign makes A indefinite.
//
// Stern and Grinspun, Multiscale Modeling and Simulation 7:4 (2009) 1779-1794, solve the implicit
// midpoint rule for the stiff part exactly. This is the first iteration of their solve. It is as
// accurate where three factorisations a step make that solve converge.
//
// Each of the five steps of order 4 turns stiff vibrations in the norm of their energy, at any
// size. So the step back in time does no harm. Kick, drift, kick with the same A
// conserves another norm at each size, and blows up.
constexpr std::array<double, 1> plain = {1};
constexpr std::array<double, 5> suzuki = [] {
  constexpr double p = 0.41449077179437573714;
  return std::array{p, p, 1 - 4 * p, p, p};
}();

template <const auto& gamma>
class LinearMidpoint final : public Formula {
 public:
  explicit LinearMidpoint(SystemRun& run)
      : Formula(run),
        split_(is_damped() ? nullptr : system().split()),
        implicit_(split_ ? *split_->stiff_block : system()),
        k_(implicit_.stiffness_pattern()),
        f_(system().size()),
        change_(system().size()),
        own_(implicit_.size()),
        own_change_(implicit_.size()) {
    if (implicit_.size() > 0) {
      matrix_ = std::make_unique<EffectiveMass>(implicit_, options().solver);
    }
  }

  void begin(const State& state, State& x) {
    x = state;
    factorized_h_ = 0;
  }

  Outcome step(const State& now, double h, State& next) {
    next.q = now.q;
    next.v = now.v;
    next.work = now.work;
    double before = 0, t = now.t;
    for (const double g : gamma) {
      t += (before + g) * h / 2;
      next.q += ((before + g) * h / 2) * next.v;
      force({t, next.q, next.v}, f_);
      if (is_driven() && !is_damped()) next.work += g * h * driving_power();
      if (const Outcome outcome = kick(g * h, t, next); outcome != Outcome::reached_end) {
        return outcome;
      }
      before = g;
    }
    next.q += (before * h / 2) * next.v;
    return Outcome::reached_end;
  }

 private:
  // v += h A^-1 f; A is M for the explicit unknowns.
  Outcome kick(double h, double t, State& next) {
    if (!split_) {
      Outcome outcome = factorize(h, {t, next.q});
      if (outcome == Outcome::reached_end) outcome = solve(f_, change_);
      if (outcome != Outcome::reached_end) return outcome;
      if (is_damped()) {
        mean_ = next.v + h / 2 * change_;
        next.work += h * power({t, next.q, mean_});
      }
      next.v += h * change_;
      return outcome;
    }
    change_ = f_.cwiseQuotient(system().mass());
    if (matrix_) {
      const std::vector<Index>& stiff = split_->stiff_unknowns;
      for (std::size_t a = 0; a < stiff.size(); ++a) own_[a] = next.q[stiff[a]];
      if (const Outcome outcome = factorize(h, {t, own_}); outcome != Outcome::reached_end) {
        return outcome;
      }
      for (std::size_t a = 0; a < stiff.size(); ++a) own_[a] = f_[stiff[a]];
      if (const Outcome outcome = solve(own_, own_change_); outcome != Outcome::reached_end) {
        return outcome;
      }
      for (std::size_t a = 0; a < stiff.size(); ++a) change_[stiff[a]] = own_change_[a];
    }
    next.v += h * change_;
    return Outcome::reached_end;
  }

  // Factorises A at x, the positions of the implicit part. With a constant K this is done for
  // another |h| only.
  Outcome factorize(double h, const At& x) {
    const bool is_constant = implicit_.stiffness_is_constant() &&
                             (!is_damped() || implicit_.damping()->damping_is_constant());
    // Only C knows the direction of time.
    const double length = is_damped() ? h : std::abs(h);
    if (is_constant && length == factorized_h_) return Outcome::reached_end;
    run_.counted().material_stiffness(implicit_, x, k_);
    if (is_damped()) subtract_damping(implicit_, x, 2 / h, k_);
    if (!k_.coeffs().allFinite()) return Outcome::not_finite;
    factorized_h_ = length;
    ++counts().factorizations;
    const Stopwatch watch(clock(), &Seconds::factorization);
    return matrix_->factorize_positive(1, h * h / 4, k_) ? Outcome::reached_end
                                                         : Outcome::indefinite_matrix;
  }

  Outcome solve(const Vec& b, Vec& x) {
    ++counts().solves;
    const Stopwatch watch(clock(), &Seconds::solve);
    return check_solve(matrix_->solve(b, x));
  }

  const Split* split_;                     // nullptr: every spring is in the matrix
  const System& implicit_;                 // the system of the matrix's stiffness
  std::unique_ptr<EffectiveMass> matrix_;  // empty if the implicit part has no unknowns
  SymmetricMatrix k_;
  Vec f_, change_, own_, own_change_;
  Vec mean_;  // of the velocities before and after a kick
  double factorized_h_ = 0;
};

}  // namespace

Method linear_midpoint() {
  return {.name = "linear_midpoint",
          .summary = "midpoint rule linear along the (stiff) springs: one solve a step, no Newton",
          .source =
              "Stern and Grinspun, Multiscale Modeling and Simulation 7:4 (2009) 1779-1794, "
              "of which this is one iteration",
          .order = 2,
          .solves_stiff_part = true,
          .traits = {Trait::implicit, Trait::cancels_torques, Trait::reversible},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solver},
          .damped = Damped::by_any,
          .make = create<LinearMidpoint<plain>>};
}

Method linear_midpoint4() {
  return {.name = "linear_midpoint4",
          .summary = "five steps of linear_midpoint, one of them backwards, composed to order 4",
          .source = "Suzuki, Physics Letters A 146 (1990) 319-323",
          .order = 4,
          .solves_stiff_part = true,
          .traits = {Trait::implicit, Trait::cancels_torques, Trait::reversible},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solver},
          .damped = Damped::by_air,
          .why_not_damped = "one of its steps goes back in time, where dashpots add energy",
          .make = create<LinearMidpoint<suzuki>>};
}

}  // namespace qddot::registered
