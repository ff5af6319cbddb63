// Explicit (forward) Euler:
//   q_{n+1} = q_n + h v_n
//   v_{n+1} = v_n + h M^-1 f(q_n)
// The method has order 1 and takes one force a step. On a vibration q'' = -w^2 q each step
// multiplies the amplitude by sqrt(1 + h^2 w^2), so it grows at every h.
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::registered {
namespace {

class ExplicitEuler final : public Formula {
 public:
  using Formula::Formula;

  Outcome step(const State& now, double h, State& next) {
    force(now, f_);
    if (does_work()) next.work = now.work + h * power();
    add_scaled(now.q, h, now.v, next.q);
    add_quotient(now.v, h, f_, system().mass(), next.v);
    return Outcome::reached_end;
  }

 private:
  Vec f_{system().size()};
};

}  // namespace

Method explicit_euler() {
  return {.name = "explicit_euler",
          .summary = "forward Euler; gains energy at every step size",
          .source = "Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, I.7",
          .stability_limit = 0,
          .make = create<ExplicitEuler>};
}

}  // namespace qddot::registered
