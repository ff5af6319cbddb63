// Implicit (backward) Euler as a minimisation over the displacement u, as the lecture ends:
//   u       = argmin 1/2 (u - h v_n)^T M (u - h v_n) + h^2 V(q_n + u)
//   q_{n+1} = q_n + u,   v_{n+1} = u/h
// At the minimum the gradient is zero, M (u - h v_n) = h^2 f(q_{n+1}), and so
//   q_{n+1} = q_n + h v_{n+1},   v_{n+1} = v_n + h M^-1 f(q_{n+1})
// The method has order 1. On a vibration q'' = -w^2 q each step divides the amplitude by
// sqrt(1 + h^2 w^2), so it decays at every h. A dashpot is a spring within the step, of the rate
// l' = (l_{n+1} - l_n)/h and the potential h/2 c l'^2: it adds h^2 times that to what is minimised.
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class ImplicitEuler final : public ImplicitStep {
 public:
  using ImplicitStep::ImplicitStep;

  Outcome step(const State& now, double h, State& next) {
    free_ = h * now.v;
    u_ = free_;
    if (is_damped()) {
      set_velocity(1 / h);
      set_lengths(-1 / h, now, 0, now);
    }
    if (const Outcome outcome = solve_stage(now.q, next.t, h * h);
        outcome != Outcome::reached_end) {
      return outcome;
    }
    next.q = now.q + u_;
    next.v = u_ / h;
    if (does_work()) next.work = now.work + h * stage_power(now.q);
    return Outcome::reached_end;
  }
};

}  // namespace

Method implicit_euler() {
  return {.name = "implicit_euler",
          .summary = "backward Euler by Newton on the incremental potential; damps at every h",
          .source = "Martin, Thomaszewski, Grinspun, Gross, SIGGRAPH 2011, section 4",
          .traits = {Trait::implicit, Trait::accepts_massless, Trait::accepts_massless_dashpots},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solve_tolerance, Option::solver},
          .damped = Damped::by_any,
          .make = create<ImplicitEuler>};
}

}  // namespace qddot::registered
