#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "qddot/integrators/base/creep.hpp"
#include "qddot/integrators/base/formula.hpp"
#include "qddot/integrators/base/hermite.hpp"
#include "qddot/integrators/base/kink_search.hpp"

namespace qddot {

// A one-step method that chooses its steps by an estimate of their errors; a derived class gives
// one attempt. An attempt is accepted if the weighted root mean square of the 2n errors is at most
// 1,
//   err^2 = 1/(2n) sum_i (e_q,i / (rtol |q_i| + atol_q))^2 + (e_v,i / (rtol |v_i| + atol_v))^2
// (the norm of SUNDIALS, with its weights: see Options). Step sizes are a PI controller's
// (Gustafsson; Hairer and Wanner, Solving ODEs II, eq. IV.2.43c); the first one is that of Hairer,
// Norsett and Wanner, Solving ODEs I, II.4. Only the end of the run is met exactly by a step.
//
// States between steps are interpolated where that is as accurate as the steps: without the
// farthest of its instants the polynomial must not change by more than `trusted` tolerances inside
// the step, in the same norm. After a sudden change of the steps it may leave the motion far
// behind. States of a step whose polynomial is not trusted are ends of separate steps from its
// start, as accurate as the run's own, and change nothing in the run.
//
// If the force jumps (see Kinks), a step ends just before the jump, whatever its error estimate. A
// step of some roundings of the time crosses it, and the next begins on the other side. Steps in
// which a length may pass through zero and return are tried again shorter. If a length turns, or
// would turn without the jump, within a few tolerances of zero, the run ends: the two ways part
// there, and which of them the motion takes is beyond the tolerance.
class AdaptiveStep : public Stepper, protected Formula {
 protected:
  // Errors are of order h^(error_order + 1). States between steps are interpolated through
  // `instants` ends of steps (three to most_instants). If `instants` is 0, each is the end of
  // separate steps, at their cost. `gives_acceleration` says whether an attempt sets the
  // acceleration at its end.
  struct Accuracy {
    int error_order;
    std::size_t instants;
    bool gives_acceleration = false;
  };
  AdaptiveStep(SystemRun& run, const Accuracy& accuracy);

  // Computes q and v into `next`, a step h [s] after `now`, and estimates of their errors (n). If
  // the outcome is not reached_end, or a result is not finite, a smaller step is tried; if there is
  // none, the run ends at `now`.
  virtual Outcome attempt(const Instant& now, double h, Instant& next, Vec& error_q,
                          Vec& error_v) = 0;
  // Called before an attempt that begins at another instant than the last one did.
  virtual void moved() {}
  // The longest step [s] allowed from there; asked once a step.
  virtual double longest_step(const Instant&) { return std::numeric_limits<double>::infinity(); }

  // An override must call this.
  void start(const State& state) override;
  // a = M^-1 f; counted.
  void acceleration(const At& at, MutableVec a);

 private:
  bool has_passed(double t) final;
  Outcome step(double t_stop) final;
  Outcome show(double t, State& state) final;
  void show_last(State& state) final;
  // The latest accepted instant, or the one `before` instants earlier.
  Instant& last(std::size_t before = 0) {
    return instants_[(newest_ + instants_.size() - before) % instants_.size()];
  }
  bool can_show(double t);
  // Whether the polynomial through the instants follows the motion after `from`, one of them.
  bool is_trusted(std::span<const Instant* const> instants, const Instant& from);
  // The work of driving from an instant to t [J], on the polynomial through the instants.
  double work_between(std::span<const Instant* const> instants, double from, double t);
  // The state at t by separate steps from that instant.
  Outcome step_aside(const Instant& from, double t, State& state);
  // Sets the acceleration at the end of an attempt unless the attempt has done so.
  void complete(Instant& next) {
    if (!accuracy_.gives_acceleration) acceleration({next.state.t, next.state.q}, next.a);
  }
  double factor_after(double error) const;
  double first_step();
  // The next step from t: h_, at most `longest`, and to the end exactly.
  double step_size(double t, double longest) const;
  Outcome take_step();
  void accept(bool is_limited);
  // The relation of a step of h to `next` with jumps of the force: it crosses none, it may cross
  // one, a jump is or may be ahead and the step is tried again with h_, or it cannot be told.
  enum class Jump { none, over, ahead, unknown };
  Jump jump(const Instant& now, const Instant& next, double h, double error);
  // The weighted root mean square of a pair of vectors.
  double norm(const State& at, const Vec& q, const Vec& v) const;

  Accuracy accuracy_;
  double atol_q_, atol_v_;
  Vec per_mass_;  // 1/m
  Vec f_;
  Vec error_q_, error_v_;
  std::vector<Instant> instants_;  // a ring buffer, with a place for the next attempt
  std::size_t newest_ = 0, count_ = 0;
  std::array<Instant, 2> aside_;
  State between_;              // scratch
  double judged_ = -INFINITY;  // [s], the start of the last step that was judged
  bool judged_trusted_ = false;
  KinkSearch kinks_;
  // While a jump is ahead: h_ as it was before, and the step over the jump; else zero.
  double h_before_jump_ = 0, over_jump_ = 0;
  double h_ = 0, last_error_ = 1;
  bool was_rejected_ = false;
  Outcome ended_ = Outcome::reached_end;  // the reason why there is no next step
  Creep creep_;
};

}  // namespace qddot
