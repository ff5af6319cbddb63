#pragma once

#include <limits>

#include "qddot/integrators/base/creep.hpp"
#include "qddot/integrators/base/hermite.hpp"
#include "qddot/integrators/base/kink_search.hpp"
#include "qddot/integrators/integrator.hpp"

namespace qddot {

// A one-step method that chooses its steps by an estimate of their errors; a derived class gives
// one attempt. An attempt is accepted if the weighted root mean square of the 2n errors is at most
// 1,
//   err^2 = 1/(2n) sum_i (e_q,i / (rtol |q_i| + atol_q))^2 + (e_v,i / (rtol |v_i| + atol_v))^2
// (the norm of SUNDIALS, with its weights: see Options). Step sizes are a PI controller's
// (Gustafsson; Hairer and Wanner, Solving ODEs II, eq. IV.2.43c); the first one is that of Hairer,
// Norsett and Wanner, Solving ODEs I, II.4. Only the end of the run is met exactly by a step.
// States between steps are interpolated, or are ends of separate attempts.
//
// If the force jumps (see Kinks), a step ends just before the jump, whatever its error estimate. A
// step of some roundings of the time crosses it, and the next begins on the other side.
class AdaptiveStep : public Integrator {
 protected:
  // Errors are of order h^(error_order + 1). States between steps are interpolated through
  // `instants` ends of steps (an even number, two to most_instants). If `instants` is 0, they are
  // separate attempts from the step before, each at its cost, as accurate as steps of any length.
  struct Accuracy {
    int error_order;
    std::size_t instants;
  };
  AdaptiveStep(const Method& method, const System& system, const Options& options,
               const Accuracy& accuracy);

  // Computes q and v into `next`, a step h [s] after `now`, and estimates of their errors (n). If
  // the outcome is not reached_end, or a result is not finite, a smaller step is tried; if there is
  // none, the run ends at `now`.
  virtual Outcome attempt(const Instant& now, double h, Instant& next, Vec& error_q,
                          Vec& error_v) = 0;
  // Called after each attempt whose errors are small enough; sets the acceleration at its end
  // unless the attempt has done so. If that is not finite, the step is rejected after all.
  virtual void accepted(Instant& next) { acceleration(next.state.q, next.a); }
  // Called after each rejected attempt.
  virtual void rejected() {}
  // The longest step [s] allowed from there; asked once a step.
  virtual double longest_step(const Instant&) { return std::numeric_limits<double>::infinity(); }

  // An override must call this.
  void start(const State& state) override;
  // a = M^-1 f(q); counted.
  void acceleration(const Vec& q, MutableVec a);

 private:
  Outcome run_to(State& state, double t_stop) final;
  // The latest accepted instant, or the one `before` instants earlier.
  Instant& last(std::size_t before = 0) {
    return instants_[(newest_ + instants_.size() - before) % instants_.size()];
  }
  bool can_show(double t);
  Outcome show(double t, State& state);
  double first_step();
  // The next step from t: h_, at most `longest`, and to the end exactly.
  double step_size(double t, double longest) const;
  Outcome take_step();
  void accept(bool is_limited);
  // The relation of a step of h to `next` with jumps of the force: it crosses none, it may cross
  // one, or a jump is ahead and the step is tried again with h_.
  enum class Jump { none, over, ahead };
  Jump jump(const Instant& now, const Instant& next, double h);
  // The weighted root mean square of a pair of vectors.
  double norm(const State& at, const Vec& q, const Vec& v) const;

  Accuracy accuracy_;
  double atol_q_, atol_v_;
  Vec per_mass_;  // 1/m
  Vec f_;
  Vec error_q_, error_v_;
  std::vector<Instant> instants_;  // a ring buffer, with a place for the next attempt
  std::size_t newest_ = 0, count_ = 0;
  KinkSearch kinks_;
  // While a jump is ahead: h_ as it was before, and the step over the jump; else zero.
  double h_before_jump_ = 0, over_jump_ = 0;
  double h_ = 0, last_error_ = 1;
  bool was_rejected_ = false;
  Outcome ended_ = Outcome::reached_end;  // the reason why there is no next step
  Creep creep_;
};

}  // namespace qddot
