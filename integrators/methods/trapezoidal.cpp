// The trapezoidal rule, which is Newmark's method with beta = 1/4 and gamma = 1/2. With
// a = M^-1 f(q):
//   q_{n+1} = q_n + h v_n + h^2/4 (a_n + a_{n+1})
//   v_{n+1} = v_n + h/2 (a_n + a_{n+1})
// A step solves one nonlinear equation for u = q_{n+1} - q_n:
//   M (u - u*) = h^2/4 f(q_n + u),   u* = h v_n + h^2/4 a_n
// The method has order 2, is A-stable and time-reversible. It is not
// symplectic, but conjugate to the implicit midpoint rule: a change of coordinates turns one into
// the other. So both are equally good over long times.
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class Trapezoidal final : public ImplicitStep {
 public:
  using ImplicitStep::ImplicitStep;

  void begin(const State& state, State& x) {
    ImplicitStep::begin(state, x);
    acceleration(state, a_);
    power_ = power();
  }

  Outcome step(const State& now, double h, State& next) {
    const double s = h * h / 4;
    free_ = h * now.v + s * a_;
    u_ = free_ + s * a_;
    if (is_damped()) set_velocity(2 / h, -now.v);
    if (const Outcome outcome = solve_stage(now.q, next.t, s); outcome != Outcome::reached_end) {
      return outcome;
    }
    next.q = now.q + u_;
    next.v = 2 / h * u_ - now.v;  // u = h/2 (v_n + v_{n+1})
    a_ = (u_ - free_) / s;
    if (does_work()) {
      const Work power = stage_power(now.q);
      next.work = now.work + h / 2 * (power_ + power);
      power_ = power;
    }
    return Outcome::reached_end;
  }

 private:
  Vec a_{system().size()};
  Work power_;  // v'Cv at the start of a step [W]
};

}  // namespace

Method trapezoidal() {
  return {.name = "trapezoidal",
          .summary = "Newmark's beta = 1/4, gamma = 1/2 (average acceleration); damps nothing",
          .source = "Newmark, Journal of the Engineering Mechanics Division 85 (1959) 67-94",
          .order = 2,
          .traits = {Trait::implicit, Trait::reversible},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solve_tolerance, Option::solver},
          .damped = Damped::by_any,
          .make = create<Trapezoidal>};
}

}  // namespace qddot::registered
