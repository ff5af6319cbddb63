#pragma once

#include <array>
#include <limits>

#include "qddot/integrators/base/creep.hpp"
#include "qddot/integrators/base/hermite.hpp"
#include "qddot/integrators/base/kink_search.hpp"
#include "qddot/integrators/integrator.hpp"

namespace qddot {

// A one-step method that chooses its steps by an estimate of their errors: what remains of it is
// one attempt. An attempt is accepted where the weighted root mean square of the 2n errors,
//   err^2 = 1/(2n) sum_i (e_q,i / (rtol |q_i| + atol_q))^2 + (e_v,i / (rtol |v_i| + atol_v))^2,
// is at most 1 (the norm of SUNDIALS, with its weights: see Options). Step sizes are a PI
// controller's (Gustafsson; Hairer and Wanner, Solving ODEs II, eq. IV.2.43c), the first one is
// that of Hairer, Norsett and Wanner, Solving ODEs I, II.4. Steps land on the end of the run only;
// what an observer sees between them is interpolated, or is the end of an attempt of its own.
//
// Where the force jumps (see Kinks), a step ends just before, whatever its error estimate says; one
// of some roundings of the time leads over it, and the next begins on the other side.
class AdaptiveStep : public Integrator {
 protected:
  // Errors are of order h^(error_order + 1); states between steps are interpolated through so many
  // ends of steps (an even number, two to most_instants). None: by an attempt of their own from the
  // step before, at its cost, and as accurate as the steps are however long.
  struct Accuracy {
    int error_order;
    std::size_t instants;
  };
  AdaptiveStep(const Method& method, const System& system, const Options& options,
               const Accuracy& accuracy);

  // Computes q and v a step h [s] after `now` into `next`, and an estimate of their errors.
  // Anything but reached_end is tried again with a smaller step and, where there is no smaller one,
  // ends the run at `now`; results that are not finite likewise.
  virtual Outcome attempt(const Instant& now, double h, Instant& next, Vec& error_q,
                          Vec& error_v) = 0;
  // Called after each attempt whose errors are small enough; sets its end's acceleration unless the
  // attempt has done so. Where that is not finite, the step is rejected after all.
  virtual void accepted(Instant& next) { acceleration(next.state.q, next.a); }
  // Called after each rejected one.
  virtual void rejected() {}
  // No step from there is to be longer [s]; asked once a step.
  virtual double longest_step(const Instant&) { return std::numeric_limits<double>::infinity(); }

  // To be called by those that override it.
  void start(const State& state) override;
  // a = M^-1 f(q); counted.
  void acceleration(const Vec& q, MutableVec a);

 private:
  Outcome run_to(State& state, double t_stop) final;
  // The latest accepted instant, or the one so many before it.
  Instant& last(std::size_t before = 0) {
    return instants_[(newest_ + instants_.size() - before) % instants_.size()];
  }
  bool can_show(double t);
  Outcome show(double t, State& state);
  double first_step();
  // From t on, if possible: h_, at most `longest`, and on the end exactly.
  double step_size(double t, double longest) const;
  Outcome take_step();
  void accept(bool is_limited);
  // What becomes of a step of h that ends at `next`, for the jumps of the force: whether it leads
  // over one, is to be tried with h_ instead, or has nothing to do with any.
  enum class Jump { none, over, ahead };
  Jump jump(const Instant& now, const Instant& next, double h);
  // The weighted root mean square of a pair of vectors.
  double norm(const State& at, const Vec& q, const Vec& v) const;

  Accuracy accuracy_;
  double atol_q_, atol_v_;
  Vec per_mass_;  // 1/m
  Vec f_;
  Vec error_q_, error_v_;
  std::vector<Instant> instants_;  // a ring, with a place for the next attempt
  std::size_t newest_ = 0, count_ = 0;
  KinkSearch kinks_;
  // While a jump is ahead: what h_ was before, and the step that leads over it; else zero.
  double h_before_jump_ = 0, over_jump_ = 0;
  double h_ = 0, last_error_ = 1;
  bool was_rejected_ = false;
  Outcome ended_ = Outcome::reached_end;  // why there is no next step
  Creep creep_;
};

}  // namespace qddot
