// Symplectic Euler:
//   v_{n+1} = v_n + h M^-1 f(q_n)
//   q_{n+1} = q_n + h v_{n+1}
// The method has order 1, is symplectic and takes one force a step. A vibration q'' = -w^2 q stays
// bounded for h w < 2 and grows above, one of the damping ratio z for h w < 2 (sqrt(1 + z^2) - z).
// The literature often calls this method semi-implicit Euler. Here semi_implicit_euler is the
// linearly implicit method of the lecture.
#include "qddot/integrators/base/compensated_sum.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class SymplecticEuler final : public Formula {
 public:
  using Formula::Formula;

  void begin(const State& state, State& x) {
    x = state;
    q_.restart();
    v_.restart();
  }

  Outcome step(const State& now, double h, State& next) {
    force(now, f_);
    v_.add_quotient(now.v, h, f_, system().mass(), next.v);
    q_.add_scaled(now.q, h, next.v, next.q);
    if (does_work()) next.work = now.work + work_of_kick(h, now.v, next.v);
    return Outcome::reached_end;
  }

 private:
  CompensatedSum q_{options().compensated, system().size()};
  CompensatedSum v_{options().compensated, system().size()};
  Vec f_{system().size()};
};

}  // namespace

Method symplectic_euler() {
  return {.name = "symplectic_euler",
          .summary = "kick, then drift; energy error stays bounded below h = 2/w_max",
          .source = "Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.9",
          .stability_limit = 2,
          .friction_lag = 1,
          .traits = {Trait::symplectic},
          .takes = {Option::compensated},
          .make = create<SymplecticEuler>};
}

}  // namespace qddot::registered
