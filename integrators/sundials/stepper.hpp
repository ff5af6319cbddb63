#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "integrators/sundials/cause.hpp"
#include "integrators/sundials/newton_matrix.hpp"
#include "integrators/sundials/support.hpp"
#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/integrator.hpp"
#include "qddot/integrators/method.hpp"

namespace qddot::sundials {

// Makes the matrix of Newton's iteration; nullptr if there is no such iteration.
using MakeMatrix = std::unique_ptr<NewtonMatrix> (*)(const System&, SUNContext, Solver);

// The stiff or soft part of a system's forces. For an undivided system it is the whole, so that a
// method can be made for it; it is never run.
inline const System& stiff_of(const System& system) {
  const Split* split = split_of(system);
  return split ? *split->stiff : system;
}
inline const System& soft_of(const System& system) {
  const Split* split = split_of(system);
  return split ? *split->soft : system;
}

// The common base of ARKODE, CVODE and IDA: the first-order form y = (q, v) in a vector of length
// 2n, single steps, and the boundary to C. No exception passes this boundary. The library chooses
// the steps, up to a stop time. If the method's knob is a step size, steps are of constant length
// and the same whatever is observed, as those of FixedStep.
class Stepper : public Integrator {
 public:
  // Newton's matrix is that of `implicit_part`: the system itself, or the implicitly treated part
  // of its forces, with the system's unknowns.
  Stepper(const Method& method, const System& system, const Options& options,
          MakeMatrix make_matrix, const System& implicit_part);
  Stepper(const Method& method, const System& system, const Options& options,
          MakeMatrix make_matrix)
      : Stepper(method, system, options, make_matrix, system) {}

 protected:
  // One internal step that does not pass the stop time; sets t [s] to the time reached.
  virtual int take_step(double t_stop, double& t) = 0;
  virtual void set_stop_time(double t_stop) = 0;
  // The length of all steps from now on [s]; called if the knob is a step size.
  virtual void set_step_size(double) {}
  // Called after each accepted step.
  virtual void note_step() {}
  // Asks the library for its own counters and gives them to set_counts.
  virtual void collect_counts() = 0;
  virtual Cause cause_of(int flag) const = 0;
  virtual std::string flag_name(int flag) const = 0;

  SUNContext context() const { return context_.get(); }
  N_Vector y() const { return y_.get(); }
  NewtonMatrix& matrix() const { return *matrix_; }
  bool has_matrix() const { return matrix_ != nullptr; }
  bool has_fixed_step() const { return method().knob == Knob::step_size; }
  double rtol() const;
  // The absolute tolerance of each entry of y: rtol times the size of positions and velocities, or
  // the user's.
  N_Vector atol() const { return atol_.get(); }
  void load(const State& state);

  // SUNDIALS' own counts; forces and stiffnesses are counted where they are evaluated.
  struct OwnCounts {
    long steps, failed_tests, failed_solves, setups, iterations;
  };
  // Sets counts(): each iteration of Newton's method is one solve, each set-up one factorisation.
  void set_counts(const OwnCounts& own);

  // Runs the body of a C callback. Returns 0 for success, 1 for a result that is not finite
  // (SUNDIALS then tries a smaller step), or -1 after an exception. The exception is stored until
  // SUNDIALS has returned. Until then no body is run again, though a fixed-point iteration tries
  // to.
  template <class Body>
  int guarded(Body body) noexcept {
    if (parked_) return -1;
    try {
      const bool is_finite = body();
      is_finite_ = is_finite_ && is_finite;
      return is_finite ? 0 : 1;
    } catch (...) {
      parked_ = std::current_exception();
      return -1;
    }
  }

  // f(q) of a part of the system into a scratch vector; counted.
  const Vec& force_at(const System& part, const Eigen::Map<Vec>& q);
  // Sets y' = (v, M^-1 f(q)); false if that is not finite.
  bool set_rate(const System& part, N_Vector y, N_Vector rate);
  // K(q) of the implicit part, kept until the next; counted.
  const SymmetricMatrix& stiffness_at(const Eigen::Map<Vec>& q);

  // Callbacks of ARKODE and CVODE, whose user data is the Stepper. They compute y' of the whole
  // system, and Newton's matrix I - gamma J of the implicit part, with a new K unless `jok`.
  static int right_hand_side(double t, N_Vector y, N_Vector rate, void* self);
  int set_matrix(N_Vector y, bool jok, int* jcur, double gamma) noexcept;
  // SUNDIALS' error handler: stores the words for the summary instead of printing them.
  static void keep_message(int code, const char* module, const char* function, char* message,
                           void* self);

  // Ends the run at t [s] with the cause of the library's flag, or with this cause.
  Outcome failure(int flag, double t) { return failure(named_cause(flag, t), flag_name(flag), t); }
  Outcome failure(Cause cause, const std::string& flag, double t);

 private:
  void begin(const State& state) final;
  Outcome run_to(State& state, double t_stop) final;
  Outcome take_chosen_steps(State& state, double t_stop);
  Outcome take_fixed_steps(State& state, double t_stop);
  // Steps from the last step to a time before the next one, by another object.
  Outcome step_aside(State& state, double t);
  Outcome take_one(State& state, double t_stop);
  // The cause that the flag names, with two corrections. If forces are not finite, a library may
  // blame convergence or its small steps, and a later force instead of the first. If it says that
  // the end is too close with time left, the weights of the first step overflow.
  Cause named_cause(int flag, double t);

  const System& implicit_part_;
  Context context_;
  Vector y_, atol_;
  std::unique_ptr<NewtonMatrix> matrix_;
  Vec per_mass_;  // 1/m
  Vec f_;
  SymmetricMatrix k_;
  State now_, next_;
  std::optional<StepTimes> times_;  // only for constant steps
  double taken_ = 0;                // number of these steps taken
  std::unique_ptr<Stepper> aside_;
  Counts beside_;  // the library's counts of steps aside
  std::exception_ptr parked_;
  double t_stop_ = 0;      // [s] of the present step
  bool is_finite_ = true;  // all that callbacks have computed in the step at hand
  std::string said_;
};

}  // namespace qddot::sundials
