#include "integrators/sundials/newton_matrix.hpp"

namespace qddot::sundials {
namespace {

SUNMatrix_ID custom_matrix(SUNMatrix) { return SUNMATRIX_CUSTOM; }
int nothing_to_zero(SUNMatrix) { return 0; }
SUNLinearSolver_Type direct(SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; }
SUNLinearSolver_ID custom_solver(SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; }
int free_shell(SUNLinearSolver solver) {
  SUNLinSolFreeEmpty(solver);  // its content belongs to its owner
  return 0;
}

}  // namespace

NewtonMatrix::NewtonMatrix(SUNContext context)
    : matrix_(check(SUNMatNewEmpty(context))), solver_(check(SUNLinSolNewEmpty(context))) {
  matrix_->ops->getid = custom_matrix;
  matrix_->ops->zero = nothing_to_zero;
  solver_->content = this;
  solver_->ops->gettype = direct;
  solver_->ops->getid = custom_solver;
  solver_->ops->setup = setup_callback;
  solver_->ops->solve = solve_callback;
  solver_->ops->free = free_shell;
}

int NewtonMatrix::setup_callback(SUNLinearSolver solver, SUNMatrix) {
  auto& self = *static_cast<NewtonMatrix*>(solver->content);
  const Stopwatch watch(self.seconds_, &Seconds::factorization);
  return self.guarded([&] { return self.factorize(); });
}

int NewtonMatrix::solve_callback(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b,
                                 double) {
  auto& self = *static_cast<NewtonMatrix*>(solver->content);
  const Stopwatch watch(self.seconds_, &Seconds::solve);
  return self.guarded([&] { return self.solve(b, x); });
}

}  // namespace qddot::sundials
