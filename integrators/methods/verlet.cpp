// Velocity Verlet (Stormer-Verlet as kick, drift, kick):
//   v_{n+1/2} = v_n + h/2 M^-1 f(q_n)
//   q_{n+1}   = q_n + h v_{n+1/2}
//   v_{n+1}   = v_{n+1/2} + h/2 M^-1 f(q_{n+1})
// The method has order 2 and is symplectic and time-reversible. The last force of a step is the
// first of the next: one force a step, and one to begin. A vibration q'' = -w^2 q stays bounded for
// h w < 2 and grows above.
//
// Friction depends on v_{n+1}, which is not known when the force is taken. There the velocity is
// predicted (the order stays 2, with one force a step):
//   f = f(q_{n+1}, v_n + h M^-1 f_n),   f_n: of the step before
// A vibration of the damping ratio z stays bounded for h w < 2 (sqrt(1 + 4 z^2) - 2 z). Each kick
// takes the energy of its friction along the mean of the velocities before and after it.
#include "qddot/integrators/base/compensated_sum.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/base/kicks_and_drift.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// With friction: all of a step but the work that friction takes, beside the force.
class DampedKicks final : public BesideForce {
 public:
  struct Next {
    Vec &q, &half, &predicted, &f, &v;  // half: v_{n+1/2}
  };
  DampedKicks(const Motion& now, double h, const Next& next) : now_(now), h_(h), next_(next) {}

  void before(Index first, Index end) override {
    half_kick_and_drift(now_, first, end, h_, next_.q, next_.half, next_.predicted);
  }
  double after(Index first, Index end) override {
    add_quotient(next_.half, first, end, h_ / 2, next_.f, now_.m, next_.v);
    return squared_norm(next_.v.segment(first, end - first));
  }

 private:
  Motion now_;
  double h_;
  Next next_;
};

// The second kick of a step, the first of the next and the drift are done in one pass over the
// vectors: x has v_{n+1/2}, and its last kick is still to come.
class Verlet final : public Formula {
 public:
  struct X : State {
    Vec f, friction;           // at q; the latter only with damping
    double half = 0;           // the kick that v lacks [s]
    double squared_speed = 0;  // |v|^2 with that kick
    Work driving;              // its power at q
  };

  using Formula::Formula;

  void begin(const State& state, X& x) {
    q_.restart();
    v_.restart();
    static_cast<State&>(x) = state;
    x.f.resize(state.q.size());
    x.half = 0;
    force(state, x.f);
    x.driving = driving_power();
    if (is_damped()) x.friction = friction();
  }

  Outcome step(const X& x, double h, X& next) {
    if (is_damped()) {
      step_damped(x, h, next);
    } else {
      step_undamped(x, h, next);
    }
    if (is_driven()) {
      next.driving = driving_power();
      if (!is_damped()) next.work = x.work;
      next.work += h / 2 * (x.driving + next.driving);
    }
    return Outcome::reached_end;
  }

  void show(const X& x, bool, State& state) {
    state.q = x.q;
    add_quotient(x.v, x.half, x.f, system().mass(), state.v);
  }

  double squared_speed(const X& next) {
    return options().compensated ? squared_norm(next.v) : next.squared_speed;
  }

 private:
  void step_undamped(const X& x, double h, X& next) {
    const Mass& mass = system().mass();
    if (options().compensated) {
      v_.add_quotient(x.v, h / 2, x.f, mass, next.v);
      q_.add_scaled(x.q, h, next.v, next.q);
      force({next.t, next.q}, next.f);
      v_.add_quotient(next.v, h / 2, next.f, mass, next.v);
      return;
    }
    KicksAndDrift kicks({x.q, x.v, x.f, mass}, {x.half, h / 2, h}, next.q, next.v);
    kicks.see_speed(h / 2, next.f);
    next.half = h / 2;
    next.squared_speed = force_beside({next.t, next.q}, next.f, kicks);
  }

  void step_damped(const X& x, double h, X& next) {
    const Mass& mass = system().mass();
    if (options().compensated) {
      add_quotient(x.v, h, x.f, mass, predicted_);
      v_.add_quotient(x.v, h / 2, x.f, mass, half_);
      q_.add_scaled(x.q, h, half_, next.q);
      force({next.t, next.q, predicted_}, next.f);
      v_.add_quotient(half_, h / 2, next.f, mass, next.v);
      next.squared_speed = squared_norm(next.v);
    } else {
      DampedKicks kicks({x.q, x.v, x.f, mass}, h, {next.q, half_, predicted_, next.f, next.v});
      next.squared_speed = force_beside({next.t, next.q, predicted_}, next.f, kicks);
    }
    take_friction(next.friction);
    next.work = x.work;
    next.work.dissipated -=
        h / 4 *
        (product_with_sum(x.v, half_, x.friction) + product_with_sum(half_, next.v, next.friction));
  }

  // Velocities, with damping.
  Vec predicted_{is_damped() ? system().size() : 0}, half_{predicted_.size()};
  CompensatedSum q_{options().compensated, system().size()};
  CompensatedSum v_{options().compensated, system().size()};
};

}  // namespace

Method verlet() {
  return {.name = "verlet",
          .summary = "velocity Verlet; one force a step, energy error bounded below h = 2/w_max",
          .source = "Hairer, Lubich, Wanner, Acta Numerica 12 (2003) 399-450, eq. 1.5",
          .order = 2,
          .stability_limit = 2,
          .friction_lag = 2,
          .traits = {Trait::symplectic, Trait::reversible},
          .needs = {Need::conservative},
          .takes = {Option::compensated},
          .damped = Damped::by_any,
          .make = create<Verlet>};
}

}  // namespace qddot::registered
