#pragma once

#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "integrators/sundials/cause.hpp"
#include "integrators/sundials/newton_matrix.hpp"
#include "integrators/sundials/support.hpp"
#include "qddot/integrators/base/creep.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"

namespace qddot::sundials {

// Makes the matrix of Newton's iteration; nullptr if there is no such iteration.
using MakeMatrix = std::unique_ptr<NewtonMatrix> (*)(const System&, SUNContext, Solver);

// The stiff or soft part of the forces of a system that is divided.
inline const System& stiff_of(const System& system) { return *system.split()->stiff; }
inline const System& soft_of(const System& system) { return *system.split()->soft; }

// The common base of ARKODE, CVODE and IDA: the first-order form y = (q, v) in a vector of length
// 2n, single steps, and the boundary to C. No exception passes this boundary. The library chooses
// the steps, up to a stop time (ChosenSteps). If the method's knob is a step size, it is a formula
// of steps of constant length (FixedSteps).
class Library : public Formula {
 public:
  // Newton's matrix is that of `implicit_part`: the system itself, or the implicitly treated part
  // of its forces, with the system's unknowns.
  Library(SystemRun& run, MakeMatrix make_matrix, const System& implicit_part);
  Library(SystemRun& run, MakeMatrix make_matrix) : Library(run, make_matrix, run.system()) {}
  // For a vector of this length with other numbers behind q and behind v, and for a matrix of the
  // derived class's own.
  Library(SystemRun& run, Index length);
  virtual ~Library() = default;

  void begin(const State& state, State& x);
  // One step of length h.
  Outcome step(const State& x, double h, State& next);
  // One step of the library's own length from `from`, the state that it has reached. It does not
  // pass the stop time t_stop.
  Outcome take(const State& from, double t_stop, State& next);
  virtual void set_stop_time(double t_stop) = 0;
  // Called after each accepted step of a chosen length.
  virtual void note_step() {}
  // Adds what the library has counted since the last call.
  void collect_counts();
  // Ends the run at t [s] because its steps creep.
  Outcome creeping(double t) { return failure(Cause::error_test, "creeping", t); }

 protected:
  // Starts the library from `state`, and its own counts from zero.
  virtual void start(const State& state) = 0;
  // One internal step that does not pass the stop time; sets t [s] to the time reached.
  virtual int take_step(double t_stop, double& t) = 0;
  // The length of all steps from now on [s]; called if the knob is a step size.
  virtual void set_step_size(double) {}
  // The power that driving gives [W].
  virtual double driving_rate(const At& at) { return power(at).driven; }
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

  // SUNDIALS' own counts since the start; forces and stiffnesses are counted where they are
  // evaluated. Each iteration of Newton's method is one solve, each set-up one factorisation.
  struct OwnCounts {
    long steps = 0, failed_tests = 0, failed_solves = 0, setups = 0, iterations = 0,
         limited_steps = 0, indefinite = 0;
  };
  virtual OwnCounts own_counts() const = 0;

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

  // f at t and y of a part of the system, in a scratch vector; counted.
  const Vec& force_at(const System& part, double t, const Halves& y);
  // Sets y' = (v, M^-1 f); false if that is not finite.
  bool set_rate(const System& part, double t, N_Vector y, N_Vector rate);
  // K of the implicit part at t and y, with its C, kept until the next; counted.
  const SymmetricMatrix& stiffness_at(double t, const Halves& y);
  // That C; nullptr if the part has no Damping.
  const SymmetricMatrix* damping_matrix() const { return c_.size() > 0 ? &c_ : nullptr; }

  // Callbacks of ARKODE and CVODE, whose user data is the Library. They compute y' of the whole
  // system, and Newton's matrix I - gamma J of the implicit part, with a new K unless `jok`.
  static int right_hand_side(double t, N_Vector y, N_Vector rate, void* self);
  int set_matrix(double t, N_Vector y, bool jok, int* jcur, double gamma) noexcept;
  // Keeps the words of SUNDIALS' errors for the summary instead of printing them. `errors` is that
  // of the memory's library (versions.hpp).
  template <class Errors>
  void hear_errors(Errors errors, void* memory) {
    check(set_error_handler<keep_words>(errors, memory, context(), this), "the error handler");
  }

  // Ends the run at t [s] with the cause of the library's flag, or with this cause.
  Outcome failure(int flag, double t) { return failure(named_cause(flag, t), flag_name(flag), t); }
  Outcome failure(Cause cause, const std::string& flag, double t);

 private:
  using MakeVector = std::function<Vector(SUNContext)>;
  Library(SystemRun& run, const System& implicit_part, Context context, const MakeVector& make);
  // Sets the work of `next` by y.
  void set_work(const State& from, State& next);
  static void keep_words(const char* words, void* self) noexcept;
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
  SymmetricMatrix k_, c_;
  OwnCounts collected_;
  bool has_begun_ = false;
  std::exception_ptr parked_;
  double t_stop_ = 0;      // [s] of the present step
  bool is_finite_ = true;  // all that callbacks have computed in the step at hand
  std::string said_;
};

// Steps of the lengths that a library L chooses. They end on the times that are shown.
template <class L>
class ChosenSteps final : public Stepper {
 public:
  explicit ChosenSteps(SystemRun& run) : run_(run), library_(run) {}

  void start(const State& state) override {
    library_.begin(state, now_);
    next_ = now_;
    t_stop_ = std::numeric_limits<double>::quiet_NaN();
  }

  bool has_passed(double t) override { return now_.t >= t; }

  Outcome step(double t_stop) override {
    if (t_stop != t_stop_) {
      t_stop_ = t_stop;
      creep_ = Creep(now_.t);
      library_.set_stop_time(t_stop);
    }
    Outcome outcome = library_.take(now_, t_stop, next_);
    if (outcome == Outcome::reached_end) outcome = run_.check_step(now_, next_);
    if (outcome != Outcome::reached_end) return outcome;
    std::swap(now_, next_);
    run_.note(now_);
    library_.note_step();
    return creep_.is_found(now_.t, t_stop) ? library_.creeping(now_.t) : Outcome::reached_end;
  }

  Outcome show(double, State& state) override {
    state = now_;
    return Outcome::reached_end;
  }

  void show_last(State& state) override {
    if (now_.t > state.t) state = now_;
  }

  void collect_counts() override { library_.collect_counts(); }

 private:
  SystemRun& run_;
  L library_;
  State now_, next_;
  Creep creep_;
  double t_stop_ = 0;  // [s]
};

// Makes the stepper of a library; for Method::make.
template <class L>
std::unique_ptr<Stepper> create_steps(SystemRun& run) {
  if (run.method().knob == Knob::step_size) return std::make_unique<FixedSteps<L>>(run);
  return std::make_unique<ChosenSteps<L>>(run);
}

}  // namespace qddot::sundials
