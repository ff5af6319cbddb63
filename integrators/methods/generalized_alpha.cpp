// Chung and Hulbert's generalised-alpha method, generalized_alpha, and its special case HHT-alpha,
// hht, of Hilber, Hughes and Taylor:
//   q_{n+1} = q_n + h v_n + h^2 ((1/2 - beta) a_n + beta a_{n+1})
//   v_{n+1} = v_n + h ((1 - gamma) a_n + gamma a_{n+1})
//   M ((1 - alpha_m) a_{n+1} + alpha_m a_n) = f((1 - alpha_f) q_{n+1} + alpha_f q_n)
//   gamma = 1/2 - alpha_m + alpha_f,   beta = 1/4 (1 - alpha_m + alpha_f)^2
// The alphas follow from rho (--spectral-radius). By this factor a step multiplies a vibration of
// infinite frequency:
//   generalized_alpha   alpha_m = (2 rho - 1)/(rho + 1),   alpha_f = rho/(rho + 1)
//   hht                 alpha_m = 0,                       alpha_f = (1 - rho)/(1 + rho)
// f is taken at the mean of the velocities, too, if it depends on them:
//   (1 - alpha_f) v_{n+1} + alpha_f v_n
// A rho below 1/2 is taken as 1/2 by hht. Both methods have order 2 and are A-stable. Each step
// solves one nonlinear equation, for the mean position at which f is taken.
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

struct Alphas {
  double m, f;
};

// Eq. 25: the alphas for this rho that damp low frequencies least.
Alphas least_damping(double rho) { return {(2 * rho - 1) / (rho + 1), rho / (rho + 1)}; }

// Hilber, Hughes, Taylor (Earthquake Engineering and Structural Dynamics 5 (1977) 283-292):
// alpha_m = 0; their alpha is -alpha_f, and rho = (1 - alpha_f)/(1 + alpha_f) >= 1/2.
Alphas without_alpha_m(double rho) {
  rho = std::max(rho, 0.5);
  return {0, (1 - rho) / (1 + rho)};
}

class GeneralizedAlpha : public ImplicitStep {
 public:
  GeneralizedAlpha(SystemRun& run, const Alphas& alpha) : ImplicitStep(run), alpha_(alpha) {}

  void begin(const State& state, State& x) {
    ImplicitStep::begin(state, x);
    acceleration(state, a_);
    power_ = power();
    last_h_ = 0;
  }

  void resume(const GeneralizedAlpha& run, const State& x, State& own) {
    ImplicitStep::begin(x, own);
    a_ = run.a_;
    power_ = run.power_;
    last_a_ = run.last_a_;
    last_h_ = run.last_h_;
  }

  // The equation of motion holds between the steps, so that a_n is the acceleration at
  // t_n + (alpha_m - alpha_f) h, to second order. A step h' after a step h needs the acceleration
  // at t_n + (alpha_m - alpha_f) h'. It is taken on the line through the last two:
  //   a_n + (alpha_m - alpha_f) (h'/h - 1) (a_n - a_{n-1})
  // Without that, each change of h would leave an error of first order in it. Steps only become
  // shorter (the last one, and those to observed times between two), so that the line is not
  // extended far.
  Outcome step(const State& now, double h, State& next) {
    if (last_h_ > 0 && h != last_h_) {
      a_ += (alpha_.m - alpha_.f) * (h / last_h_ - 1) * (a_ - last_a_);
    }
    const double gamma = 0.5 - alpha_.m + alpha_.f;
    const double beta = 0.25 * (1 - alpha_.m + alpha_.f) * (1 - alpha_.m + alpha_.f);
    const double s = (1 - alpha_.f) * beta / (1 - alpha_.m) * h * h;
    free_ = (1 - alpha_.f) * (h * now.v + h * h * (0.5 - beta) * a_) - s * alpha_.m * a_;
    u_ = free_ + s * a_;
    if (is_damped()) {
      const double part = (1 - alpha_.f) * h, rate = part * gamma / ((1 - alpha_.m) * s);
      const double of_a = 1 - gamma - gamma * alpha_.m / (1 - alpha_.m);
      set_velocity(rate, now.v + part * of_a * a_ - rate * free_);
    }
    if (const Outcome outcome = solve_stage(now.q, now.t + (1 - alpha_.f) * h, s);
        outcome != Outcome::reached_end) {
      return outcome;
    }
    last_a_ = a_;
    a_ = ((u_ - free_) / s - alpha_.m * last_a_) / (1 - alpha_.m);
    next.q = now.q + u_ / (1 - alpha_.f);
    next.v = now.v + h * ((1 - gamma) * last_a_ + gamma * a_);
    last_h_ = h;
    if (does_work()) {
      // The trapezoidal rule, at the ends of steps.
      const Work power = this->power({next.t, next.q, next.v});
      next.work = now.work + h / 2 * (power_ + power);
      power_ = power;
    }
    return Outcome::reached_end;
  }

 private:
  const Alphas alpha_;
  Vec a_{system().size()}, last_a_{system().size()};
  Work power_;         // v'Cv at the start of a step [W]
  double last_h_ = 0;  // 0: no step yet, and a_ is that of the start
};

class ChungHulbert final : public GeneralizedAlpha {
 public:
  explicit ChungHulbert(SystemRun& run)
      : GeneralizedAlpha(run, least_damping(run.options().spectral_radius)) {}
};

class Hht final : public GeneralizedAlpha {
 public:
  explicit Hht(SystemRun& run)
      : GeneralizedAlpha(run, without_alpha_m(run.options().spectral_radius)) {}
};

}  // namespace

Method generalized_alpha() {
  return {.name = "generalized_alpha",
          .summary = "second order; damps infinite frequencies by the spectral radius a step",
          .source = "Chung and Hulbert, Journal of Applied Mechanics 60 (1993) 371-375, eq. 25",
          .order = 2,
          .traits = {Trait::implicit, Trait::remembers_steps},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solve_tolerance, Option::spectral_radius, Option::solver},
          .damped = Damped::by_any,
          .make = create<ChungHulbert>};
}

Method hht() {
  return {.name = "hht",
          .summary = "HHT-alpha: Newmark with damping, the finite-element codes' default",
          .source = "Hilber, Hughes, Taylor, Earthquake Eng. Struct. Dyn. 5 (1977) 283-292",
          .order = 2,
          .traits = {Trait::implicit, Trait::remembers_steps},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solve_tolerance, Option::spectral_radius, Option::solver},
          .damped = Damped::by_any,
          .make = create<Hht>};
}

}  // namespace qddot::registered
