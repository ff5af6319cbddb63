// The two-step backward differentiation formula, BDF2. With y = (q, v), y' = (v, M^-1 f(q)) and
// equal steps it is
//   y_{n+1} = 4/3 y_n - 1/3 y_{n-1} + 2/3 h y'_{n+1}
// A step h that follows a step of another length h_1 uses their ratio r = h/h_1 (w in the code):
//   y_{n+1} = ((1 + r)^2 y_n - r^2 y_{n-1})/(1 + 2 r) + c h y'_{n+1},   c = (1 + r)/(1 + 2 r)
// Eliminating v_{n+1} leaves one nonlinear equation a step, with Newton's matrix M - c^2 h^2 K. The
// method has order 2 and is A-stable and L-stable. The first step is implicit Euler's. The error of
// that one step is of order h^2, so the order of the method stays 2.
//
// A dashpot is a spring within the step. The rate l' of its length is by the same formula:
//   c h l'_{n+1} = l_{n+1} - l_n - back (l_n - l_{n-1}),   back = r^2/(1 + 2 r)
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class Bdf2 final : public ImplicitStep {
 public:
  using ImplicitStep::ImplicitStep;

  void begin(const State& state, State& x) {
    ImplicitStep::begin(state, x);
    last_h_ = 0;
  }

  void resume(const Bdf2& run, const State& x, State& own) {
    begin(x, own);
    last_ = run.last_;
    last_h_ = run.last_h_;
  }

  Outcome step(const State& now, double h, State& next) {
    const double w = last_h_ > 0 ? h / last_h_ : 0;  // w = 0: implicit Euler
    const double back = w * w / (1 + 2 * w), c = (1 + w) / (1 + 2 * w);
    if (w == 0) last_ = now;
    // q_{n+1} - q_n = back (q_n - q_{n-1}) + c h v_{n+1}, and v likewise.
    known_ = back * (now.q - last_.q);
    free_ = known_ + c * h * (now.v + back * (now.v - last_.v));
    u_ = free_;
    if (w > 0) u_ = known_ + c * h * (now.v + w * (now.v - last_.v));
    if (is_damped()) {
      set_velocity(1 / (c * h), -known_ / (c * h));
      set_lengths(-(1 + back) / (c * h), now, back / (c * h), last_);
    }
    if (const Outcome outcome = solve_stage(now.q, next.t, c * c * h * h);
        outcome != Outcome::reached_end) {
      return outcome;
    }
    next.q = now.q + u_;
    next.v = (u_ - known_) / (c * h);
    if (does_work()) {
      next.work = now.work + back * (now.work - last_.work) + c * h * stage_power(now.q);
      last_.work = now.work;
    }
    last_.t = now.t;
    last_.q = now.q;
    last_.v = now.v;
    last_h_ = h;
    return Outcome::reached_end;
  }

 private:
  State last_{0, Vec(system().size()), Vec(system().size())};
  double last_h_ = 0;
  Vec known_{system().size()};
};

}  // namespace

Method bdf2() {
  return {
      .name = "bdf2",
      .summary = "two-step backward differentiation; one solve a step, damps fast vibrations",
      .source = "Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, III.1, III.5",
      .order = 2,
      .traits = {Trait::implicit, Trait::accepts_massless, Trait::accepts_massless_dashpots,
                 Trait::remembers_steps},
      .needs = {Need::conservative, Need::stiffness},
      .takes = {Option::solve_tolerance, Option::solver},
      .damped = Damped::by_any,
      .make = create<Bdf2>};
}

}  // namespace qddot::registered
