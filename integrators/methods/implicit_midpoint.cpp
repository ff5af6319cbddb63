// The implicit midpoint rule. With the displacement u from q_n to the midpoint (q_n + q_{n+1})/2:
//   M (u - h/2 v_n) = h^2/4 f(q_n + u)
//   q_{n+1} = q_n + 2 u,   v_{n+1} = 4 u/h - v_n
// The method has order 2 and is symplectic and time-reversible. It keeps linear and angular
// momentum, and where f is linear also the energy, at every h. It is A-stable, but the energy of a
// stiff nonlinear spring may grow.
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class ImplicitMidpoint final : public ImplicitStep {
 public:
  explicit ImplicitMidpoint(SystemRun& run) : ImplicitStep(run, tolerance_for_invariants) {}

  void begin(const State& state, State& x) {
    ImplicitStep::begin(state, x);
    acceleration(state, a_);
  }

  Outcome step(const State& now, double h, State& next) {
    const double s = h * h / 4;
    free_ = h / 2 * now.v;
    u_ = free_ + s * a_;
    if (is_damped()) set_velocity(2 / h);
    if (const Outcome outcome = solve_stage(now.q, now.t + h / 2, s);
        outcome != Outcome::reached_end) {
      return outcome;
    }
    a_ = (u_ - free_) / s;
    if (does_work()) next.work = now.work + h * stage_power(now.q);
    next.q = now.q + 2 * u_;
    next.v = 4 / h * u_ - now.v;
    return Outcome::reached_end;
  }

 private:
  Vec a_{system().size()};  // at the last step's midpoint; predicts the next
};

}  // namespace

Method implicit_midpoint() {
  return {.name = "implicit_midpoint",
          .summary = "symplectic and A-stable; keeps momenta, and energy where f is linear",
          .source = "Hairer, Lubich, Wanner, Geometric Numerical Integration, eq. II.1.7",
          .order = 2,
          .traits = {Trait::implicit, Trait::symplectic, Trait::reversible},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solve_tolerance, Option::solver},
          .damped = Damped::by_any,
          .make = create<ImplicitMidpoint>};
}

}  // namespace qddot::registered
