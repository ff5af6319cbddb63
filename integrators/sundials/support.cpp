#include "integrators/sundials/support.hpp"

#include <fmt/format.h>

#include "qddot/algebra/solver.hpp"

namespace qddot::sundials {

void check(int flag, const char* call) {
  if (flag < 0) throw SolverFailure(fmt::format("{} failed with flag {}", call, flag));
}

Context make_context() {
  SUNContext context = nullptr;
  check(SUNContext_Create(SUN_COMM_NULL, &context), "SUNContext_Create");
  return Context(context);
}

}  // namespace qddot::sundials
