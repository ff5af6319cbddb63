// Takahashi and Imada's splitting of order 4, processed (Rowlands). A step drifts, kicks with the
// force a little farther along itself, and drifts:
//   x = q + h/2 v,   v' = v + h M^-1 f(x + h^2/12 M^-1 f(x)),   q' = x + h/2 v'.
// By itself it is of order 2; its error is that of other coordinates, so that between
//   q -> q + s M^-1 f(q),   v -> v - s M^-1 K(q) v,   s = h^2/24,
// before the first step and the inverse of that where a state is shown it is of order 4. Two forces
// a step. On q'' = -w^2 q with z = h^2 w^2 a step turns by the angle of cosine 1 - z/2 + z^2/24: no
// vibration grows for h w < sqrt(12).
//
// K v is the central difference of f along v, over a thousandth of a step to either side: the
// change of coordinates takes three forces, its inverse four.
#include <cmath>

#include "qddot/integrators/base/fixed_step.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::registered {
namespace {

constexpr double part_of_step = 1e-3;

class TakahashiImada4 final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  // Positions and velocities in the coordinates of the steps.
  struct Kernel {
    Vec q, v;
  };

  void start(const State&) override { has_begun_ = false; }

  Outcome step(const State& now, double h, State& next) override {
    if (h != options().step_size) {  // the last, or to a time between steps
      next_ = {now.q, now.v};
      enter(next_, h);
      advance(next_, h);
      leave(next_, h, next);
      return Outcome::reached_end;
    }
    if (!has_begun_) {
      now_ = {now.q, now.v};
      enter(now_, h);
      has_begun_ = true;
    }
    next_ = now_;
    advance(next_, h);
    next.q = next_.q;
    next.v = next_.v;
    leave_incomplete();
    return Outcome::reached_end;
  }

  void accepted() override { std::swap(now_, next_); }
  bool completes_at_a_cost() const override { return true; }

  void complete(State& now, bool may_evaluate) override {
    if (may_evaluate) leave(now_, options().step_size, now);
  }

  void advance(Kernel& kernel, double h) {
    const Vec& mass = system().mass();
    add_scaled(kernel.q, h / 2, kernel.v, kernel.q);
    force(kernel.q, f_);
    add_quotient(kernel.q, h * h / 12, f_, mass, x_);
    force(x_, f_);
    add_quotient(kernel.v, h, f_, mass, kernel.v);
    add_scaled(kernel.q, h / 2, kernel.v, kernel.q);
  }

  // (f(q + e v) - f(q - e v))/(2 e) = K v + O(e^2)
  void set_stiffness_times(const Vec& q, const Vec& v, double e, Vec& k_v) {
    add_scaled(q, e, v, x_);
    force(x_, k_v);
    add_scaled(q, -e, v, x_);
    force(x_, f_);
    add_scaled(k_v, -1, f_, k_v);
    k_v /= 2 * e;
  }

  void enter(Kernel& at, double h) {
    const double s = h * h / 24;
    set_stiffness_times(at.q, at.v, part_of_step * h, k_v_);
    force(at.q, f_);
    add_quotient(at.q, s, f_, system().mass(), at.q);
    add_quotient(at.v, -s, k_v_, system().mass(), at.v);
  }

  // Solves q + s M^-1 f(q) = kernel.q by two iterations and v - s M^-1 K(q) v = kernel.v by one,
  // which leave errors of order 6 and 4. A second one for v makes energies no better.
  void leave(const Kernel& kernel, double h, State& to) {
    const double s = h * h / 24;
    to.q = kernel.q;
    for (int i = 0; i < 2; ++i) {
      force(to.q, f_);
      add_quotient(kernel.q, -s, f_, system().mass(), to.q);
    }
    set_stiffness_times(to.q, kernel.v, part_of_step * h, k_v_);
    add_quotient(kernel.v, s, k_v_, system().mass(), to.v);
  }

  Kernel now_, next_;
  bool has_begun_ = false;
  Vec f_{system().size()}, x_{system().size()}, k_v_{system().size()};
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
          .make = create<TakahashiImada4>};
}

}  // namespace qddot::registered
