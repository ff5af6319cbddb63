// Velocity Verlet (Stormer-Verlet as kick, drift, kick):
//   v_{n+1/2} = v_n + h/2 M^-1 f(q_n)
//   q_{n+1}   = q_n + h v_{n+1/2}
//   v_{n+1}   = v_{n+1/2} + h/2 M^-1 f(q_{n+1})
// The method has order 2 and is symplectic and time-reversible. The last force of a step is the
// first of the next: one force a step, and one to begin. A vibration q'' = -w^2 q stays bounded for
// h w < 2 and grows above.
#include "qddot/integrators/base/compensated_sum.hpp"
#include "qddot/integrators/base/fixed_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// The second kick of a step, the first of the next and the drift are done in one pass over the
// vectors: a step ends with v_{n+1/2} until it is observed.
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
    const Vec& mass = system().mass();
    if (options().compensated) {
      v_.add_quotient(now.v, h / 2, f_, mass, next.v);
      q_.add_scaled(now.q, h, next.v, next.q);
      force(next.q, f_);
      v_.add_quotient(next.v, h / 2, f_, mass, next.v);
      return Outcome::reached_end;
    }
    kick_and_drift({now.q, now.v, f_, mass}, is_complete() ? 0 : half_, h / 2, h, next.q, next.v);
    force(next.q, f_next_);
    half_next_ = h / 2;
    leave_incomplete();
    return Outcome::reached_end;
  }

  double squared_speed(const State& next) override {
    return squared_norm_of_kicked(next.v, half_next_, f_next_, system().mass());
  }

  void accepted() override {
    if (options().compensated) return;
    f_.swap(f_next_);
    half_ = half_next_;
  }

  void complete(State& now, bool) override {
    add_quotient(now.v, half_, f_, system().mass(), now.v);
  }

  CompensatedSum q_{options().compensated, system().size()};
  CompensatedSum v_{options().compensated, system().size()};
  Vec f_{system().size()}, f_next_{system().size()};  // at the start and at the end of the step
  double half_ = 0, half_next_ = 0;                   // last kick of the step that led there [s]
};

}  // namespace

Method verlet() {
  return {.name = "verlet",
          .summary = "velocity Verlet; one force a step, energy error bounded below h = 2/w_max",
          .source = "Hairer, Lubich, Wanner, Acta Numerica 12 (2003) 399-450, eq. 1.5",
          .order = 2,
          .stability_limit = 2,
          .traits = {Trait::symplectic, Trait::reversible},
          .takes = {Option::compensated},
          .make = create<Verlet>};
}

}  // namespace qddot::registered
