// TR-BDF2: the trapezoidal rule over the part g h of a step, then BDF2 through both points. With
// y = (q, v) and y' = (v, M^-1 f(q)):
//   y_g     = y_n + g h/2 (y'_n + y'_g)
//   y_{n+1} = y_n + b (y_g - y_n) + g h/2 y'_{n+1},   g = 2 - sqrt 2,   b = 1/(g (2 - g))
// With this g both stages have the matrix M - (g h/2)^2 K. The method has order 2 and is A-stable
// and L-stable. The acceleration of the last stage is the first of the next step.
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

const double g = 2 - std::sqrt(2.0);
const double b = 1 / (g * (2 - g));

class TrBdf2 final : public ImplicitStep {
 public:
  using ImplicitStep::ImplicitStep;

  void begin(const State& state, State& x) {
    ImplicitStep::begin(state, x);
    acceleration(state, a_);
    power_ = power();
  }

  Outcome step(const State& now, double h, State& next) {
    const double c = g * h / 2, s = c * c;
    free_ = 2 * c * now.v + s * a_;
    u_ = free_ + s * a_;
    if (is_damped()) set_velocity(1 / c, -now.v);
    if (const Outcome outcome = solve_stage(now.q, now.t + g * h, s);
        outcome != Outcome::reached_end) {
      return outcome;
    }
    ug_ = u_;
    vg_ = u_ / c - now.v;
    a_ = (u_ - free_) / s;
    Work work;  // in the step
    if (does_work()) work = c * (power_ + stage_power(now.q));

    free_ = b * ug_ + c * (now.v + b * (vg_ - now.v));
    u_ = free_ + s * a_;
    if (is_damped()) set_velocity(1 / c, -b / c * ug_);
    if (const Outcome outcome = solve_stage(now.q, next.t, s); outcome != Outcome::reached_end) {
      return outcome;
    }
    next.q = now.q + u_;
    next.v = (u_ - b * ug_) / c;
    a_ = (u_ - free_) / s;
    if (does_work()) {
      power_ = stage_power(now.q);
      next.work = now.work + b * work + c * power_;
    }
    return Outcome::reached_end;
  }

 private:
  Vec a_{system().size()};
  Work power_;  // v'Cv at the start of a step [W]
  Vec ug_{system().size()}, vg_{system().size()};
};

}  // namespace

Method trbdf2() {
  return {.name = "trbdf2",
          .summary = "trapezoidal rule, then BDF2; two solves a step with one matrix, L-stable",
          .source = "Hosea and Shampine, Applied Numerical Mathematics 20 (1996) 21-37",
          .order = 2,
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solve_tolerance, Option::solver},
          .damped = Damped::by_any,
          .make = create<TrBdf2>};
}

}  // namespace qddot::registered
