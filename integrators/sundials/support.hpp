#pragma once

#include <memory>
#include <new>
#include <type_traits>

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>

#include "integrators/sundials/versions.hpp"
#include "qddot/model/capabilities.hpp"

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
using Context = std::unique_ptr<std::remove_pointer_t<SUNContext>, FreeContext>;
Context make_context();

// Frees a SUNDIALS object of type T by its own function.
template <auto free_function>
struct FreeBy {
  template <class T>
  void operator()(T* object) const {
    free_function(object);
  }
};
// Frees one whose function wants a pointer to the pointer.
template <auto free_function>
struct FreeMemoryBy {
  void operator()(void* memory) const { free_function(&memory); }
};
using Vector = std::unique_ptr<_generic_N_Vector, FreeBy<N_VDestroy>>;
using Matrix = std::unique_ptr<_generic_SUNMatrix, FreeBy<SUNMatDestroy>>;
using LinearSolver = std::unique_ptr<_generic_SUNLinearSolver, FreeBy<SUNLinSolFree>>;
using NonlinearSolver = std::unique_ptr<_generic_SUNNonlinearSolver, FreeBy<SUNNonlinSolFree>>;

// The two halves of a stacked vector y = (q, v) of length 2n. If the system has Damping or Driving,
// y has one more entry, the energy W [J] that friction has taken less what driving has given.
struct Halves {
  explicit Halves(N_Vector y)
      : n(N_VGetLength(y) / 2), q(N_VGetArrayPointer(y), n), v(N_VGetArrayPointer(y) + n, n) {}
  Index n;
  Eigen::Map<Vec> q, v;
};

// The entry W of such a vector, and whether it has one.
inline bool has_work(N_Vector y) { return N_VGetLength(y) % 2 == 1; }
inline double& work(N_Vector y) { return N_VGetArrayPointer(y)[N_VGetLength(y) - 1]; }

// The length of y for the system.
inline Index stacked_size(const System& system) {
  return 2 * system.size() + (system.damping() || system.driving() ? 1 : 0);
}

// A zero vector of that length for y: SUNDIALS' own serial one.
Vector make_stock_vector(Index length, SUNContext context);
// The same with the main operations of a step compiled for this processor. Sums of several vectors
// are made in one pass, and the weighted norm adds in several lanes. Its clones are alike.
Vector make_vector(Index length, SUNContext context);
// Another zero vector of the same kind.
Vector clone(N_Vector y);

}  // namespace qddot::sundials
