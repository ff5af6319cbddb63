// Semi-implicit (linearly implicit) Euler, as in the lecture and in Baraff and Witkin, SIGGRAPH
// 1998:
//   (M - h^2 K(q_n)) v_{n+1} = M v_n + h f(q_n)
//   q_{n+1} = q_n + h v_{n+1}
// This is implicit Euler with f linearised at q_n, one Newton step of it from v = 0. On a vibration
// q'' = -w^2 q it is implicit Euler. It has order 1 and takes one force, one factorisation and one
// solve a step, but one factorisation a run where K is constant.
//
// Dashpots and air add h C(q_n) to the matrix.
//
// The literature calls symplectic_euler semi-implicit as well; that is another method. Compressed
// springs may make the matrix indefinite. It is solved with as it stands. A singular matrix ends
// the run, and conjugate gradients end it at an indefinite one.
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class SemiImplicitEuler final : public Formula {
 public:
  using Formula::Formula;

  void begin(const State& state, State& x) {
    x = state;
    factorized_h_ = 0;
  }

  Outcome step(const State& now, double h, State& next) {
    const At at(next.t, now.q);
    if (is_damped() && is_driven()) {
      force({next.t, now.q, none_}, f_);  // dashpots of supports that move pull nodes at rest
    } else {
      force(at, f_);
    }
    if (!factorize(at, h)) return indefinite_at(at);
    b_ = system().mass().cwiseProduct(now.v) + h * f_;
    if (const Outcome outcome = solve(b_, next.v); outcome != Outcome::reached_end) {
      return outcome;
    }
    if (does_work()) {
      next.work = now.work + h * power({next.t, now.q, next.v});
    }
    next.q = now.q + h * next.v;
    return Outcome::reached_end;
  }

 private:
  // Factorises M - h^2 K unless the last factors are of this matrix.
  bool factorize(const At& at, double h) {
    const bool is_constant = system().stiffness_is_constant() &&
                             (!is_damped() || system().damping()->damping_is_constant());
    if (is_constant && h == factorized_h_) return true;
    stiffness(at, k_);
    if (is_damped()) subtract_damping(system(), at, 1 / h, k_);
    ++counts().factorizations;
    factorized_h_ = h;
    const Stopwatch watch(clock(), &Seconds::factorization);
    return matrix_.factorize(1, h * h, k_) != EffectiveMass::Definiteness::singular;
  }

  Outcome solve(const Vec& b, Vec& x) {
    const Stopwatch watch(clock(), &Seconds::solve);
    ++counts().solves;
    const Outcome outcome = check_solve(matrix_.solve(b, x));
    if (outcome == Outcome::indefinite_matrix) {
      set_message(
          "compressed springs make M - h^2 K indefinite, with which conjugate gradients cannot "
          "solve: take --solver multifrontal, which can, or a shorter step");
    }
    return outcome;
  }

  Vec f_{system().size()}, b_{system().size()}, none_{Vec::Zero(system().size())};
  SymmetricMatrix k_{system().stiffness_pattern()};
  EffectiveMass matrix_{system(), options().solver};
  double factorized_h_ = 0;
};

}  // namespace

Method semi_implicit_euler() {
  return {.name = "semi_implicit_euler",
          .summary = "linearly implicit Euler; one linear solve a step, damps",
          .source = "Baraff and Witkin, Large Steps in Cloth Simulation, SIGGRAPH 1998, eq. 6",
          .traits = {Trait::implicit, Trait::linearly_implicit, Trait::accepts_massless,
                     Trait::accepts_massless_dashpots},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solver},
          .damped = Damped::by_any,
          .make = create<SemiImplicitEuler>};
}

}  // namespace qddot::registered
