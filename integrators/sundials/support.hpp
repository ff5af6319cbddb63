#pragma once

#include <exception>
#include <memory>
#include <string>

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "integrators/integrator.hpp"
#include "src/model/first_order.hpp"

namespace qddot::sundials {

// Throws std::runtime_error that names the call unless `flag` says success (>= 0); in every build.
void check(int flag, const char* call);
// Throws std::bad_alloc unless the pointer is one.
template <class T>
T* check(T* pointer) {
  if (!pointer) throw std::bad_alloc();
  return pointer;
}

struct FreeContext {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
using Context = std::unique_ptr<_SUNContext, FreeContext>;

// Frees a SUNDIALS object of type T by its own function.
template <auto free_function>
struct FreeBy {
  template <class T>
  void operator()(T* object) const {
    free_function(object);
  }
};
using Vector = std::unique_ptr<_generic_N_Vector, FreeBy<N_VDestroy>>;
using Matrix = std::unique_ptr<_generic_SUNMatrix, FreeBy<SUNMatDestroy>>;
using LinearSolver = std::unique_ptr<_generic_SUNLinearSolver, FreeBy<SUNLinSolFree>>;

// The two halves of a stacked vector y = (q, v) of length 2n.
struct Halves {
  explicit Halves(N_Vector y)
      : n(N_VGetLength(y) / 2), q(N_VGetArrayPointer(y), n), v(N_VGetArrayPointer(y) + n, n) {}
  Index n;
  Eigen::Map<Vec> q, v;
};

// What ARKODE and IDA share when they are used the stock way: the first-order form in a serial
// N_Vector of length 2n, KLU on the sparse 2n x 2n matrix, internal steps up to a stop time, and
// the boundary to C, across which no exception passes.
class Stock : public Integrator {
 public:
  Stock(const Method& method, const System& system, const Knobs& knobs);

 protected:
  // One internal step that does not pass the stop time; sets t [s] to the time reached.
  virtual int take_step(double t_stop, double& t) = 0;
  virtual void set_stop_time(double t_stop) = 0;
  // Asks SUNDIALS for its own counters and gives them to set_counts.
  virtual void collect_counts() = 0;
  virtual Outcome outcome_of(int flag) const = 0;
  virtual std::string flag_name(int flag) const = 0;

  SUNContext context() const { return context_.get(); }
  N_Vector y() const { return y_.get(); }
  SUNMatrix matrix() const { return matrix_.get(); }
  SUNLinearSolver linear_solver() const { return linear_solver_.get(); }
  double rtol() const { return knobs().rtol; }
  // One SI unit times rtol unless the user gave it: 1 m for q, 1 m/s for v.
  double atol() const { return knobs().atol > 0 ? knobs().atol : knobs().rtol; }
  void load(const State& state);

  // What SUNDIALS counts by itself; forces and stiffnesses are counted where they are evaluated.
  struct OwnCounts {
    long steps, failed_tests, failed_solves, setups, iterations;
  };
  // Into counts(): each iteration of Newton's method is one solve, each set-up one factorisation.
  void set_counts(const OwnCounts& own);

  // Runs the body of a C callback: 0 done, 1 recoverable (a result is not finite, so that SUNDIALS
  // tries a smaller step), -1 with the exception parked until SUNDIALS has returned.
  template <class Body>
  int guarded(Body body) noexcept {
    try {
      return body() ? 0 : 1;
    } catch (...) {
      parked_ = std::current_exception();
      return -1;
    }
  }

  // f(q) into the system-sized scratch vector; counted.
  const Vec& force_at(const Eigen::Map<Vec>& q);
  // [[alpha I, beta I], [diag(s) K(q), diag(e)]] into a matrix of the pattern; counted.
  void fill(SUNMatrix target, const Eigen::Map<Vec>& q, double alpha, double beta, const Vec& s,
            const Vec& e);

  // SUNDIALS' error handler: keeps the words for the summary in place of printing them.
  static void keep_message(int code, const char* module, const char* function, char* message,
                           void* self);

 private:
  Outcome run_to(State& state, double t_stop) final;
  Outcome advance_steps(State& state, double t_stop);
  Outcome failure(int flag, double t);

  Context context_;
  FirstOrderPattern pattern_;
  Vector y_;
  Matrix matrix_;
  LinearSolver linear_solver_;
  Vec q_, f_;
  SymmetricMatrix k_;
  std::exception_ptr parked_;
  std::string said_;
};

}  // namespace qddot::sundials
