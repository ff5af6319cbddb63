#include "integrators/sundials/newton_test.hpp"

#include <sunnonlinsol/sunnonlinsol_newton.h>

namespace qddot::sundials {
namespace {

// Fractions of the tolerance for the error of a step: the error that may be left, and a first
// correction that is negligible.
constexpr double largest_rest = 3e-3;
constexpr double negligible = 1e-3;
// More corrections than this show that the factors are too old; two or three are usual.
constexpr int most_corrections = 10;

}  // namespace

NewtonTest::NewtonTest(N_Vector y, SUNContext context)
    : solver_(check(SUNNonlinSol_Newton(y, context))) {}

void NewtonTest::attach() {
  check(SUNNonlinSolSetConvTestFn(solver(), has_converged, this), "SUNNonlinSolSetConvTestFn");
  check(SUNNonlinSolSetMaxIters(solver(), most_corrections), "SUNNonlinSolSetMaxIters");
}

int NewtonTest::has_converged(SUNNonlinearSolver solver, N_Vector, N_Vector correction, double,
                              N_Vector weight, void* user) {
  auto& self = *static_cast<NewtonTest*>(user);
  int iteration = 0;
  if (SUNNonlinSolGetCurIter(solver, &iteration) != SUN_SUCCESS) return SUN_NLS_CONV_RECVR;
  const double size = N_VWrmsNorm(correction, weight);
  const double theta = size / self.last_size_;
  self.last_size_ = size;
  if (size <= negligible) return SUN_SUCCESS;
  if (iteration == 0) return SUN_NLS_CONTINUE;
  if (!(theta < 1)) return SUN_NLS_CONV_RECVR;
  return theta / (1 - theta) * size <= largest_rest ? SUN_SUCCESS : SUN_NLS_CONTINUE;
}

}  // namespace qddot::sundials
