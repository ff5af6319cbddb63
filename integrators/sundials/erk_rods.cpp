// ARKODE's adaptive explicit method of order 8 on the equations of motion with constraints, in the
// form of index 1: the multipliers are functions of places and velocities,
//   A lambda = G M^-1 f + g'' at q'' = 0,   A = G M^-1 G'
//   y' = (v, M^-1 (f - G'lambda)),          y = (q, v)
// Its exact motion keeps g and G v + dg/dt; errors of steps let both drift. So each accepted step
// is projected back onto both (Hairer, Lubich, Wanner, Geometric Numerical Integration (2006),
// IV.4), along M^-1 G', which moves it by no more than its own error.
#include <cmath>

#include "integrators/sundials/arkode.hpp"
#include "integrators/sundials/imaginary_stability.hpp"
#include "integrators/sundials/prince_dormand.hpp"
#include "qddot/algebra/multipliers.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

class ErkRods final : public Arkode {
 public:
  explicit ErkRods(SystemRun& run) : ErkRods(run, prince_dormand_8_7()) {}

 private:
  ErkRods(SystemRun& run, ButcherTable table)
      : Arkode(run, {.explicit_table = table.get()}, rate_on_constraints, nullptr, nullptr,
               run.system()),
        constraints_(system().constraints()),
        multipliers_(system()),
        g_(multipliers_.count()) {
    limit_steps(system(), imaginary_stability(*table));
    if (constraints_) check(set_postprocess_step(memory(), project), "the projection");
  }

  At place(double t, const Halves& y) {
    return run_.counted().placed({t, VecView(y.q.data(), y.n), VecView(y.v.data(), y.n)});
  }

  static int rate_on_constraints(double t, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<ErkRods*>(static_cast<Library*>(user));
    return self.guarded([&] { return self.set_constrained_rate(t, y, rate); });
  }

  bool set_constrained_rate(double t, N_Vector y, N_Vector rate) {
    const Halves at(y);
    Halves change(rate);
    change.q = at.v;
    f_ = force_at(system(), t, at);
    double taken = power().taken();
    if (constraints_) {
      const At here = place(t, at);
      multipliers_.take_gradients(here);
      if (!multipliers_.factorize()) return false;
      const Vec& lambda = multipliers_.forces_at(here, f_);
      f_.noalias() -= multipliers_.gradients().transpose() * lambda;
      constraints_->constraint_rates(here, g_);
      taken -= lambda.dot(g_);
    }
    change.v = f_.cwiseQuotient(system().mass());
    if (has_work(rate)) sundials::work(rate) = taken;
    return std::isfinite(change.v.sum());
  }

  static int project(double t, N_Vector y, void* user) {
    auto& self = *static_cast<ErkRods*>(static_cast<Library*>(user));
    return self.guarded([&] {
      Halves at(y);
      self.q_ = at.q;
      self.v_ = at.v;
      if (!self.multipliers_.project(self.place(t, at), self.q_, self.v_)) return false;
      at.q = self.q_;
      at.v = self.v_;
      return true;
    });
  }

  double driving_rate(const At& at) override {
    const double own = Library::driving_rate(at);
    if (!constraints_) return own;
    const At there = run_.counted().placed(at);
    f_.resize(there.q.size());
    system().force(there, f_);
    multipliers_.take_gradients(there);
    if (!multipliers_.factorize()) return own;
    constraints_->constraint_rates(there, g_);
    return own + g_.dot(multipliers_.forces_at(there, f_));
  }

  const Constraints* constraints_;  // nullptr in a part without
  Multipliers multipliers_;
  Vec f_, g_, q_, v_;
};

}  // namespace

Method arkode_erk8_rods() {
  return {.name = "arkode_erk8_rods",
          .summary =
              "SUNDIALS ARKODE with rods: adaptive explicit of order 8 in the form of index "
              "1, projected",
          .source = "Prince and Dormand, J. Computational and Applied Mathematics 7 (1981) 67-75",
          .order = 8,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::bounds_steps},
          .needs = {Need::constraints},
          .make = create_steps<ErkRods>};
}

}  // namespace qddot::registered
