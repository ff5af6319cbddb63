// The classical Runge-Kutta method on (q, v)' = (v, M^-1 f(q)):
//   q_1 = q_n,                 v_1 = v_n,                 a_i = M^-1 f(q_i)
//   q_2 = q_n + h/2 v_1,       v_2 = v_n + h/2 a_1
//   q_3 = q_n + h/2 v_2,       v_3 = v_n + h/2 a_2
//   q_4 = q_n + h v_3,         v_4 = v_n + h a_3
//   q_{n+1} = q_n + h/6 (v_1 + 2 v_2 + 2 v_3 + v_4)
//   v_{n+1} = v_n + h/6 (a_1 + 2 a_2 + 2 a_3 + a_4)
// The method has order 4 and takes four forces a step. On a vibration q'' = -w^2 q each step
// multiplies the amplitude by about 1 - (h w)^6/144 for small h w. Above h w = 2 sqrt 2 the
// amplitude grows.
#include <cmath>

#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::registered {
namespace {

class Rk4 final : public Formula {
 public:
  using Formula::Formula;

  Outcome step(const State& now, double h, State& next) {
    const Mass& mass = system().mass();
    const double middle = now.t + h / 2;
    force(now, f_);
    if (does_work()) next.work = now.work + h / 6 * power();
    add_scaled(now.q, h / 2, now.v, q_);
    add_scaled(now.q, h / 6, now.v, next.q);
    add_quotient(now.v, h / 6, f_, mass, next.v);
    // Each pass gives the stage's velocity, and from it the position of the stage after it.
    kick_and_drift({now.q, now.v, f_, mass}, 0, h / 2, h / 2, q_after_, v_);
    add_stage({middle, q_, v_}, h / 3, next);
    kick_and_drift({now.q, now.v, f_, mass}, 0, h / 2, h, q_, v_);
    add_stage({middle, q_after_, v_}, h / 3, next);
    add_quotient(now.v, h, f_, mass, v_);
    add_stage({next.t, q_, v_}, h / 6, next);
    return Outcome::reached_end;
  }

 private:
  // Computes f at a stage and adds `weight` times the stage's rate to `next`.
  void add_stage(const At& stage, double weight, State& next) {
    force(stage, f_);
    if (does_work()) next.work += weight * power();
    add_scaled(next.q, weight, stage.v, next.q);
    add_quotient(next.v, weight, f_, system().mass(), next.v);
  }

  Vec q_{system().size()}, q_after_{system().size()}, v_{system().size()}, f_{system().size()};
};

}  // namespace

Method rk4() {
  return {.name = "rk4",
          .summary = "the classical Runge-Kutta method; four forces a step",
          .source =
              "Kutta, Z. Math. Phys. 46 (1901) 435-453; Hairer, Norsett and Wanner, Solving "
              "ODEs I, table II.1.2",
          .order = 4,
          .stability_limit = 2 * std::sqrt(2),
          .make = create<Rk4>};
}

}  // namespace qddot::registered
