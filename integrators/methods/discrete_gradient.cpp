// The energy-momentum method. It is the implicit midpoint rule with a mean force F over the step,
// the capability DiscreteGradient, in place of the force at the midpoint:
//   q_{n+1} = q_n + h/2 (v_n + v_{n+1})
//   M (v_{n+1} - v_n) = h F(q_n, q_{n+1})
// Along q_{n+1} - q_n the mean force does exactly the work V(q_n) - V(q_{n+1}). So kinetic energy
// gains what potential energy loses, whatever h is. With u = q_{n+1} - q_n a step is one nonlinear
// equation:
//   M (u - h v_n) = h^2/2 F(q_n, q_n + u)
// Its Newton matrix is taken as M - h^2/4 K(q_n + u/2). There the derivative of F is K/2, up to
// terms of first order in u. Dashpots and air add -C(q_n + u/2) u/h to F, and so take the energy
// u'Cu/h exactly. The method has order 2 and is time-reversible. It keeps energy, linear
// and angular momentum up to what the nonlinear solve leaves.
#include "qddot/integrators/base/implicit_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class EnergyMomentum final : public ImplicitStep {
 public:
  explicit EnergyMomentum(SystemRun& run) : ImplicitStep(run, tolerance_for_invariants) {}

  void begin(const State& state, State& x) {
    ImplicitStep::begin(state, x);
    acceleration(state, a_);
  }

  Outcome step(const State& now, double h, State& next) {
    const double s = h * h / 2;
    free_ = h * now.v;
    u_ = free_ + s * a_;
    if (is_damped()) set_velocity(1 / h);
    if (const Outcome outcome = solve_stage(now.q, now.t + h / 2, s);
        outcome != Outcome::reached_end) {
      return outcome;
    }
    a_ = (u_ - free_) / s;
    next.q = now.q + u_;
    if (does_work()) next.work = now.work + work_of_step(now, h, next);
    next.v = 2 / h * u_ - now.v;
    return Outcome::reached_end;
  }

 private:
  // The mean force is that of the middle of the step in time. So driving gives the changes of V in
  // time at both ends, and the balance is exact.
  Work work_of_step(const State& now, double h, const State& next) {
    Work work;
    if (is_damped()) {
      work.dissipated = h * stage_power(now.q).dissipated;
      if (is_driven()) work.driven = h * driving_power().dissipated;
    }
    if (is_driven()) {
      const CountedSystem& counted = run_.counted();
      const double middle = now.t + h / 2;
      work.driven += counted.potential_change(now.t, middle, now.q) +
                     counted.potential_change(middle, next.t, next.q);
    }
    return work;
  }

  void stage_force(const Vec& q, const Vec& u, Vec& f) override {
    x_ = q + u;
    mean_force({stage_time(), q}, {stage_time(), x_}, f);
    if (!is_damped()) return;
    stage_power(q);
    f += friction();
  }
  double friction_part() const override { return 0.5; }
  void stage_stiffness(const Vec& q, const Vec& u, double compression_weight,
                       SymmetricMatrix& k) override {
    x_ = q + u / 2;
    run_.counted().weighted_stiffness({stage_time(), x_}, compression_weight, k);
    k.coeffs() /= 2;
  }
  bool is_minimisation() const override { return false; }
  bool knows_start() const override { return true; }

  Vec a_{system().size()};  // the mean of the last step; predicts the next
  Vec x_{system().size()};
};

}  // namespace

Method discrete_gradient() {
  return {.name = "discrete_gradient",
          .summary = "keeps energy and momenta at every h, to what its nonlinear solve leaves",
          .source = "Gonzalez, Journal of Nonlinear Science 6 (1996) 449-467, section 4",
          .order = 2,
          .traits = {Trait::implicit, Trait::cancels_torques, Trait::reversible},
          .needs = {Need::conservative, Need::stiffness, Need::discrete_gradient,
                    Need::balance_in_time},
          .takes = {Option::solve_tolerance, Option::solver},
          .damped = Damped::by_any,
          .make = create<EnergyMomentum>};
}

}  // namespace qddot::registered
