// Velocity Verlet (Stormer-Verlet, kick - drift - kick):
//   v_{n+1/2} = v_n + h/2 M^-1 f(q_n)
//   q_{n+1}   = q_n + h v_{n+1/2}
//   v_{n+1}   = v_{n+1/2} + h/2 M^-1 f(q_{n+1})
// Order 2, symplectic, time-reversible. The last force of a step is the first of the next: one
// evaluation a step, and one to begin. Bounded on q'' = -w^2 q for h w < 2, unbounded above.
#include "qddot/integrators/base/compensated_sum.hpp"
#include "qddot/integrators/base/fixed_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class Verlet final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  void start(const State& state) override {
    q_.restart();
    v_.restart();
    force(state.q, f_);
  }

  Outcome step(const State& now, double h, State& next) override {
    v_.add_quotient(now.v, h / 2, f_, system().mass(), next.v);
    q_.add_scaled(now.q, h, next.v, next.q);
    force(next.q, f_);
    v_.add_quotient(next.v, h / 2, f_, system().mass(), next.v);
    return Outcome::reached_end;
  }

  CompensatedSum q_{options().compensated, system().size()};
  CompensatedSum v_{options().compensated, system().size()};
  Vec f_{system().size()};  // at the present state
};

}  // namespace

Method verlet() {
  return {.name = "verlet",
          .summary = "velocity Verlet; one force a step, energy error bounded below h = 2/w_max",
          .source = "Hairer, Lubich, Wanner, Acta Numerica 12 (2003) 399-450, eq. 1.5",
          .order = 2,
          .stability_limit = 2,
          .traits = {Trait::symplectic},
          .takes = {Option::compensated},
          .make = create<Verlet>};
}

}  // namespace qddot::registered
