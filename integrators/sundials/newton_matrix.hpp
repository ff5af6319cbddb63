#pragma once

#include <exception>
#include <memory>
#include <utility>

#include "integrators/sundials/support.hpp"
#include "qddot/integrators/integrator.hpp"

namespace qddot::sundials {

// The matrix of SUNDIALS' Newton iterations on y = (q, v), and its solver. SUNDIALS decides when it
// is set up anew and from which K and C. SUNDIALS itself has a SUNMatrix without entries and a
// SUNLinearSolver that refers to this. K and C are borrowed and must not change between set_... and
// the last solve with its factors, which may compute a residual.
class NewtonMatrix {
 public:
  explicit NewtonMatrix(SUNContext context);
  virtual ~NewtonMatrix() = default;
  NewtonMatrix(const NewtonMatrix&) = delete;
  NewtonMatrix& operator=(const NewtonMatrix&) = delete;

  // I - gamma J of y' = (v, M^-1 f), J = [[0, I], [M^-1 K, -M^-1 C]]. `damping` is C, or nullptr
  // for none. The derivatives of the energy that friction takes are left out: nothing depends on
  // it.
  virtual void set_explicit_form(double gamma, const SymmetricMatrix& k,
                                 const SymmetricMatrix* damping = nullptr) = 0;
  // c dF/dy' + dF/dy = [[c I, -I], [-K, c M + C]] of F = (q' - v, M v' - f). A massless unknown has
  // -v in the first half of F, so its c is zero there.
  virtual void set_implicit_form(double c, const SymmetricMatrix& k,
                                 const SymmetricMatrix* damping = nullptr) = 0;

  SUNMatrix matrix() const { return matrix_.get(); }
  SUNLinearSolver solver() const { return solver_.get(); }

  // Sets the record that its time is added to, or nullptr.
  void time_into(Seconds* seconds) { seconds_ = seconds; }
  // The number of indefinite matrices so far: compressed springs outweighed the mass.
  std::int64_t indefinite() const { return indefinite_; }
  // Clears the state of the last run, such as counts and KLU's pivots.
  virtual void begin_run() { indefinite_ = 0; }
  // Rethrows an exception that was caught in a C callback since the last call.
  void rethrow() {
    if (parked_) std::rethrow_exception(std::exchange(parked_, nullptr));
  }

 protected:
  void count_indefinite() { ++indefinite_; }

 private:
  // Both return 0, or 1 if a smaller step may help.
  virtual int factorize() = 0;
  virtual int solve(N_Vector b, N_Vector x) = 0;

  // Runs the body of a C callback. No exception may pass C code: it is stored, and -1 returned.
  template <class Body>
  int guarded(Body body) noexcept {
    try {
      return body();
    } catch (...) {
      parked_ = std::current_exception();
      return -1;
    }
  }
  static int setup_callback(SUNLinearSolver solver, SUNMatrix);
  static int solve_callback(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double);

  Matrix matrix_;
  LinearSolver solver_;
  Seconds* seconds_ = nullptr;
  std::int64_t indefinite_ = 0;
  std::exception_ptr parked_;
};

// The second-order structure: eliminating one half leaves the symmetric n x n matrix
// M - gamma^2 K, gamma = 1/c (derivation in structured.cpp).
std::unique_ptr<NewtonMatrix> make_structured(const System& system, SUNContext context,
                                              Solver solver);
// KLU on all 2n x 2n entries, as SUNDIALS' users do.
std::unique_ptr<NewtonMatrix> make_klu(const System& system, SUNContext context, Solver);

}  // namespace qddot::sundials
