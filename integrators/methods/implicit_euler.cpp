// Implicit (backward) Euler as optimisation, as the lecture ends:
//   q_{n+1} = q_n + u,  v_{n+1} = u/h,
//   u = argmin 1/2 (u - h v_n)' M (u - h v_n) + h^2 V(q_n + u)
// (v_{n+1} minimises 1/2 (v - v_n)' M (v - v_n) + V(q_n + h v)). Order 1. On q'' = -w^2 q the
// amplitude decays by 1/sqrt(1 + h^2 w^2) each step, at every h.
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class ImplicitEuler final : public ImplicitStep {
 public:
  using ImplicitStep::ImplicitStep;

 private:
  Outcome step(const State& now, double h, State& next) override {
    free_ = h * now.v;
    u_ = free_;
    if (const Outcome outcome = solve_stage(now.q, h * h); outcome != Outcome::reached_end) {
      return outcome;
    }
    next.q = now.q + u_;
    next.v = u_ / h;
    return Outcome::reached_end;
  }
};

}  // namespace

Method implicit_euler() {
  return {.name = "implicit_euler",
          .summary = "backward Euler by Newton on the incremental potential; damps at every h",
          .source = "Martin, Thomaszewski, Grinspun, Gross, SIGGRAPH 2011, section 4",
          .traits = {Trait::implicit, Trait::accepts_massless},
          .needs = {Need::stiffness},
          .takes = {Option::solve_tolerance, Option::solver},
          .make = create<ImplicitEuler>};
}

}  // namespace qddot::registered
