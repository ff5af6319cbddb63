#include "integrators/sundials/arkode.hpp"

namespace qddot::sundials {
namespace {

constexpr int steps_with_one_matrix = 5;
constexpr int extrapolate = 1;  // ARKODE's number for that predictor

}  // namespace

Arkode::Arkode(SystemRun& run, const Tables& tables, ARKRhsFn explicit_rate, ARKRhsFn implicit_rate,
               MakeMatrix make_matrix, const System& implicit_part)
    : ArkodeStepper(run, make_matrix, implicit_part),
      explicit_rate_(explicit_rate),
      implicit_rate_(implicit_rate) {
  keep(ARKStepCreate(explicit_rate, implicit_rate, 0, y(), context()));
  set_tolerances();
  const auto* either = tables.implicit_table ? tables.implicit_table : tables.explicit_table;
  check(ARKStepSetTables(memory(), either->q, either->p, tables.implicit_table,
                         tables.explicit_table),
        "ARKStepSetTables");
  if (!has_matrix()) return;
  check(ARKodeSetLinearSolver(memory(), matrix().solver(), matrix().matrix()),
        "ARKodeSetLinearSolver");
  check(ARKodeSetLinSysFn(memory(), linear_system), "ARKodeSetLinSysFn");
  newton_ = std::make_unique<NewtonTest>(y(), context());
  check(ARKodeSetNonlinearSolver(memory(), newton_->solver()), "ARKodeSetNonlinearSolver");
  newton_->attach();
  // The rate at a stage is computed as (z - known part)/(h a_ii), not as f of its solution z. f
  // multiplies what Newton's iteration has left on stiff modes by (h w)^2. The error test would
  // take that for an error of the formula (Hairer and Wanner, Solving ODEs II, section IV.8).
  check(ARKodeSetDeduceImplicitRhs(memory(), 1), "ARKodeSetDeduceImplicitRhs");
  // K is recomputed with the factors, at least every few steps. The iteration then takes half as
  // many rounds as with ARKODE's own policy (K every 50 steps, a start at y_n).
  check(ARKodeSetJacEvalFrequency(memory(), 1), "ARKodeSetJacEvalFrequency");
  check(ARKodeSetLSetupFrequency(memory(), steps_with_one_matrix), "ARKodeSetLSetupFrequency");
  // Each stage starts on the parabola through the last step, which costs no force of its own.
  check(ARKodeSetInterpolantDegree(memory(), 2), "ARKodeSetInterpolantDegree");
  check(ARKodeSetPredictorMethod(memory(), extrapolate), "ARKodeSetPredictorMethod");
}

int Arkode::restart(double t) {
  return ARKStepReInit(memory(), explicit_rate_, implicit_rate_, t, y());
}

int Arkode::linear_system(double t, N_Vector y, N_Vector, SUNMatrix, SUNMatrix, int jok, int* jcur,
                          double gamma, void* self, N_Vector, N_Vector, N_Vector) {
  return static_cast<Arkode*>(static_cast<Library*>(self))->set_matrix(t, y, jok, jcur, gamma);
}

}  // namespace qddot::sundials
