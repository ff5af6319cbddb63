// Takahashi and Imada's splitting of order 4, processed. A step drifts, kicks and drifts. Its kick
// takes the force at a point that lies a little farther along the force:
//   x       = q_n + h/2 v_n
//   v_{n+1} = v_n + h M^-1 f(x + h^2/12 M^-1 f(x))
//   q_{n+1} = x + h/2 v_{n+1}
// Alone such a step has order 2. Its error of second order is a change of coordinates
// (Rowlands). This change is made before the first step and undone where a state is shown:
//   q <- q + s M^-1 f(q),   v <- v - s M^-1 K(q) v,   s = h^2/24
// So the method has order 4, with two forces a step. On a vibration q'' = -w^2 q, with z = h^2 w^2,
// a step turns by the angle of cosine 1 - z/2 + z^2/24. No vibration grows for h w < sqrt 12.
#include <cmath>

#include "qddot/integrators/base/fixed_step.hpp"
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
class TakahashiImada4 final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  // Positions and velocities in the coordinates of the steps.
  struct Kernel {
    Vec q, v;
  };
  // The forces of a step, at its middle and shifted.
  struct Kick {
    Vec f, shifted;
  };

  void start(const State&) override { has_begun_ = ahead_is_known_ = false; }

  Outcome step(const State& now, double h, State& next) override {
    if (h != options().step_size) {  // the last step, or one to a time between steps
      enter(now, h, now_);
      has_begun_ = ahead_is_known_ = false;
      advance(h);
      std::swap(now_, next_);
      std::swap(behind_, ahead_);
      ahead_is_known_ = false;
      leave(h, next);
      return Outcome::reached_end;
    }
    if (!has_begun_) enter(now, h, now_);
    has_begun_ = true;
    advance(h);
    next.q = next_.q;
    next.v = next_.v;
    leave_incomplete();
    return Outcome::reached_end;
  }

  void accepted() override {
    std::swap(now_, next_);
    std::swap(behind_, ahead_);
    ahead_is_known_ = false;
  }

  void complete(State& now, bool may_evaluate) override {
    if (may_evaluate) leave(options().step_size, now);
  }

  // Computes the forces of a step h from now_; leaves the position of the first one in next_.q.
  void look_ahead(double h) {
    add_scaled(now_.q, h / 2, now_.v, next_.q);
    if (ahead_is_known_) return;
    force(next_.q, ahead_.f);
    add_quotient(next_.q, h * h / 12, ahead_.f, system().mass(), x_);
    force(x_, ahead_.shifted);
    ahead_is_known_ = true;
  }

  // Advances from now_ to next_.
  void advance(double h) {
    look_ahead(h);
    add_quotient(now_.v, h, ahead_.shifted, system().mass(), next_.v);
    add_scaled(next_.q, h / 2, next_.v, next_.q);
  }

  // K v is the central difference of f along v, over a thousandth of a step to either side.
  void enter(const State& from, double h, Kernel& to) {
    const double s = h * h / 24, e = 1e-3 * h;
    const Vec& mass = system().mass();
    add_scaled(from.q, e, from.v, x_);
    force(x_, ahead_.f);
    add_scaled(from.q, -e, from.v, x_);
    force(x_, behind_.f);
    add_quotient(from.v, -s / (2 * e), ahead_.f, mass, to.v);
    add_quotient(to.v, s / (2 * e), behind_.f, mass, to.v);
    force(from.q, ahead_.f);
    add_quotient(from.q, s, ahead_.f, mass, to.q);
  }

  // Transforms now_, which a step h has reached, to the motion's own coordinates.
  void leave(double h, State& to) {
    look_ahead(h);
    const double s = h * h / 24;
    const Vec& mass = system().mass();
    x_ = 3 * (behind_.f + ahead_.f) - (behind_.shifted + ahead_.shifted);
    add_quotient(now_.q, -s / 4, x_, mass, to.q);
    add_quotient(now_.v, s / h, ahead_.f, mass, to.v);
    add_quotient(to.v, -s / h, behind_.f, mass, to.v);
  }

  Kernel now_ = two_vectors<Kernel>(), next_ = two_vectors<Kernel>();
  Kick behind_ = two_vectors<Kick>(), ahead_ = two_vectors<Kick>();
  bool has_begun_ = false;
  bool ahead_is_known_ = false;  // whether ahead_ belongs to now_
  Vec x_{system().size()};

  template <class T>
  T two_vectors() const {
    return {Vec(system().size()), Vec(system().size())};
  }
};

std::vector<std::complex<double>> roots(double h_omega) {
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
          .make = create<TakahashiImada4>};
}

}  // namespace qddot::registered
