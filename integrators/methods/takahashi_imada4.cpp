// Takahashi and Imada's splitting of order 4, processed. A step drifts, kicks and drifts. Its kick
// takes the force at a point that lies a little farther along the force:
//   x       = q_n + h/2 v_n
//   v_{n+1} = v_n + h M^-1 f(x + h^2/12 M^-1 f(x))
//   q_{n+1} = x + h/2 v_{n+1}
// Alone such a step has order 2. Its error of second order is a change of coordinates
// (Rowlands). This change is made before the first step and undone where a state is shown:
//   q <- q + s M^-1 f(q),   v <- v - s M^-1 K(q) v,   s = h^2/24
// With forces of time, K v stands for df/dt along the motion, and t moves with x.
// So the method has order 4, with two forces a step. On a vibration q'' = -w^2 q, with z = h^2 w^2,
// a step turns by the angle of cosine 1 - z/2 + z^2/24. No vibration grows for h w < sqrt 12.
#include <cmath>

#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::registered {
namespace {

// The change of coordinates is undone without forces of its own. The steps before and after a state
// (q, v) have their forces at q - h/2 v and q + h/2 v: F- and F+, and the shifted G- and G+. So
//   f = (F- + F+)/2,   K v = (F+ - F-)/h,   2 s K M^-1 f = (G- - F- + G+ - F+)/2,
// exactly where f is linear and but for terms of h^2 elsewhere. The series of the inverse begins
// with
//   q - s M^-1 f + s^2 M^-1 K M^-1 f = q - s/4 M^-1 (3 (F- + F+) - (G- + G+)),
//   v + s M^-1 K v = v + s/h M^-1 (F+ - F-).
// Its next term for v does not make energies more accurate.
class TakahashiImada4 final : public Formula {
  // The forces of a step, at its middle and shifted, and the power of driving at both.
  struct Kick {
    Vec f, shifted;
    Work power, shifted_power;
  };

 public:
  struct X : State {
    bool has_begun = false;  // whether q and v are in the coordinates of the steps
    bool has_ahead = false;  // whether `ahead`, of the step from here, is known
    Kick behind, ahead;
    bool is_shown = false;  // whether the state is known:
    Vec shown_q, shown_v;
    Work shown_work;
  };

  using Formula::Formula;

  void begin(const State& state, X& x) {
    static_cast<State&>(x) = state;
    x.has_begun = x.has_ahead = x.is_shown = false;
    for (Vec* all :
         {&x.behind.f, &x.behind.shifted, &x.ahead.f, &x.ahead.shifted, &x.shown_q, &x.shown_v}) {
      all->resize(state.q.size());
    }
    entered_ = x;
    state_ = state;
  }

  Outcome step(X& x, double h, X& next) {
    const bool is_last = h != options().step_size;  // or one to a time between steps
    const bool enters = is_last || !x.has_begun;
    if (enters) {
      show(x, true, state_);
      enter(h);
    }
    X& from = enters ? entered_ : x;
    look_ahead(from, h);
    add_quotient(from.v, h, from.ahead.shifted, system().mass(), next.v);
    add_scaled(middle_, h / 2, next.v, next.q);
    next.work = from.work + h * from.ahead.shifted_power;
    std::swap(from.ahead, next.behind);
    next.has_begun = true;
    from.has_ahead = next.has_ahead = next.is_shown = false;
    if (is_last) {
      look_ahead(next, h);
      leave(next, h, next.q, next.v, next.work);
      next.has_begun = false;
    }
    return Outcome::reached_end;
  }

  void show(X& x, bool may_evaluate, State& state) {
    if (x.has_begun && may_evaluate && !x.is_shown) {
      look_ahead(x, options().step_size);
      x.shown_work = x.work;
      leave(x, options().step_size, x.shown_q, x.shown_v, x.shown_work);
      x.is_shown = true;
    }
    const bool is_other = x.has_begun && x.is_shown;
    state.q = is_other ? x.shown_q : x.q;
    state.v = is_other ? x.shown_v : x.v;
    state.work = is_other ? x.shown_work : x.work;
  }

 private:
  // Computes the forces of a step h from x; leaves the position of the first one in middle_.
  void look_ahead(X& x, double h) {
    add_scaled(x.q, h / 2, x.v, middle_);
    if (x.has_ahead) return;
    const double t = x.t + h / 2;
    force({t, middle_}, x.ahead.f);
    x.ahead.power = driving_power();
    add_quotient(middle_, h * h / 12, x.ahead.f, system().mass(), x_);
    force({t, x_}, x.ahead.shifted);
    x.ahead.shifted_power = driving_power();
    x.has_ahead = true;
  }

  // Transforms state_ to the coordinates of steps h, in entered_. K v is the central difference of
  // f along v, over a thousandth of a step to either side.
  void enter(double h) {
    const double s = h * h / 24, e = 1e-3 * h;
    const Mass& mass = system().mass();
    const double t = state_.t;
    X& to = entered_;
    add_scaled(state_.q, e, state_.v, x_);
    force({t + e, x_}, to.ahead.f);
    to.work = state_.work - s / (2 * e) * driving_power();
    add_scaled(state_.q, -e, state_.v, x_);
    force({t - e, x_}, to.behind.f);
    to.work += s / (2 * e) * driving_power();
    add_quotient(state_.v, -s / (2 * e), to.ahead.f, mass, to.v);
    add_quotient(to.v, s / (2 * e), to.behind.f, mass, to.v);
    force({t, state_.q}, to.ahead.f);
    add_quotient(state_.q, s, to.ahead.f, mass, to.q);
    to.t = t;
    to.has_ahead = false;
  }

  // Transforms x, which a step h has reached and whose forces ahead are known, to the motion's own
  // coordinates; q, v and work may be those of x.
  void leave(const X& x, double h, Vec& q, Vec& v, Work& work) {
    const double s = h * h / 24;
    const Mass& mass = system().mass();
    x_ = 3 * (x.behind.f + x.ahead.f) - (x.behind.shifted + x.ahead.shifted);
    add_quotient(x.q, -s / 4, x_, mass, q);
    add_quotient(x.v, s / h, x.ahead.f, mass, v);
    add_quotient(v, -s / h, x.behind.f, mass, v);
    work = work + s / h * (x.ahead.power - x.behind.power);
  }

  X entered_;
  State state_;
  Vec middle_{system().size()}, x_{system().size()};
};

std::vector<std::complex<double>> roots(double h_omega, double /*zeta*/) {
  const double z = h_omega * h_omega, cosine = 1 - z / 2 + z * z / 24;
  // 1 - cosine and 1 + cosine without cancellation.
  const double less = z / 2 * (1 - z / 12), more = 2 - less;
  if (less >= 0) {
    const double sine = std::sqrt(less * more);
    return {{cosine, sine}, {cosine, -sine}};
  }
  const double larger = cosine + std::sqrt(-less * more);
  return {larger, 1 / larger};
}

}  // namespace

Method takahashi_imada4() {
  return {.name = "takahashi_imada4",
          .summary = "processed splitting of order 4, two forces a step; for energies of long runs",
          .source =
              "Takahashi and Imada, J. Physical Society of Japan 53 (1984) 3765-3769; Rowlands, J. "
              "Computational Physics 97 (1991) 235-239; the shifted force: Omelyan, Physical "
              "Review E 74 (2006) 036703",
          .order = 4,
          .stability_limit = std::sqrt(12),
          .recurrence_roots = roots,
          .traits = {Trait::remembers_steps},
          .needs = {Need::conservative},
          .why_not_damped = "its change of coordinates is for forces of positions",
          .make = create<TakahashiImada4>};
}

}  // namespace qddot::registered
