#include "integrators/sundials/arkode.hpp"

#include <fmt/format.h>

namespace qddot::sundials {
namespace {

constexpr int steps_with_one_matrix = 5;
constexpr int extrapolate = 1;  // ARKODE's number for that predictor

// ARKODE takes its own fraction of the bound, which must be below 1.
constexpr double fraction = 0.99;

}  // namespace

Arkode::Arkode(SystemRun& run, const Tables& tables, ARKRhsFn explicit_rate, ARKRhsFn implicit_rate,
               MakeMatrix make_matrix, const System& implicit_part)
    : Library(run, make_matrix, implicit_part),
      explicit_rate_(explicit_rate),
      implicit_rate_(implicit_rate),
      memory_(check(ARKStepCreate(explicit_rate, implicit_rate, 0, y(), context()))) {
  check(ARKStepSetUserData(memory(), static_cast<Library*>(this)), "ARKStepSetUserData");
  check(ARKStepSetErrHandlerFn(memory(), keep_message, static_cast<Library*>(this)),
        "ARKStepSetErrHandlerFn");
  const auto* either = tables.implicit_table ? tables.implicit_table : tables.explicit_table;
  check(ARKStepSetTables(memory(), either->q, either->p, tables.implicit_table,
                         tables.explicit_table),
        "ARKStepSetTables");
  check(ARKStepSVtolerances(memory(), rtol(), atol()), "ARKStepSVtolerances");
  check(ARKStepSetMaxHnilWarns(memory(), -1), "ARKStepSetMaxHnilWarns");
  if (!has_matrix()) return;
  check(ARKStepSetLinearSolver(memory(), matrix().solver(), matrix().matrix()),
        "ARKStepSetLinearSolver");
  check(ARKStepSetLinSysFn(memory(), linear_system), "ARKStepSetLinSysFn");
  newton_ = std::make_unique<NewtonTest>(y(), context());
  check(ARKStepSetNonlinearSolver(memory(), newton_->solver()), "ARKStepSetNonlinearSolver");
  newton_->attach();
  // The rate at a stage is computed as (z - known part)/(h a_ii), not as f of its solution z. f
  // multiplies what Newton's iteration has left on stiff modes by (h w)^2. The error test would
  // take that for an error of the formula (Hairer and Wanner, Solving ODEs II, section IV.8).
  check(ARKStepSetDeduceImplicitRhs(memory(), 1), "ARKStepSetDeduceImplicitRhs");
  // K is recomputed with the factors, at least every few steps. The iteration then takes half as
  // many rounds as with ARKODE's own policy (K every 50 steps, a start at y_n).
  check(ARKStepSetJacEvalFrequency(memory(), 1), "ARKStepSetJacEvalFrequency");
  check(ARKStepSetLSetupFrequency(memory(), steps_with_one_matrix), "ARKStepSetLSetupFrequency");
  // Each stage starts on the parabola through the last step, which costs no force of its own.
  check(ARKStepSetInterpolantDegree(memory(), 2), "ARKStepSetInterpolantDegree");
  check(ARKStepSetPredictorMethod(memory(), extrapolate), "ARKStepSetPredictorMethod");
}

void Arkode::limit_steps(const System& part, double y) {
  limit_.emplace(Limit{part, y, Vec(part.size()), RenewedBound(part)});
  check(ARKStepSetStabilityFn(memory(), stable_step, this), "ARKStepSetStabilityFn");
  check(ARKStepSetCFLFraction(memory(), fraction), "ARKStepSetCFLFraction");
}

int Arkode::stable_step(N_Vector y, double t, double* h, void* user) {
  auto& self = *static_cast<Arkode*>(user);
  return self.guarded([&] {
    Limit& limit = *self.limit_;
    const double w_max = limit.w_max.at(limit.calls++, [&](SymmetricMatrix& k) {
      limit.q = Halves(y).q;
      self.stiffness(limit.part, {t, limit.q}, k);
    });
    *h = w_max > 0 ? limit.y / (fraction * w_max) : INFINITY;
    return true;
  });
}

void Arkode::start(const State& state) {
  load(state);
  if (limit_) {
    limit_->calls = 0;
    limit_->w_max.start();
  }
  check(ARKStepReInit(memory(), explicit_rate_, implicit_rate_, state.t, y()), "ARKStepReInit");
}

void Arkode::set_stop_time(double t_stop) {
  check(ARKStepSetStopTime(memory(), t_stop), "ARKStepSetStopTime");
}

void Arkode::set_step_size(double h) {
  check(ARKStepSetFixedStep(memory(), h), "ARKStepSetFixedStep");
}

int Arkode::take_step(double t_stop, double& t) {
  return ARKStepEvolve(memory(), t_stop, y(), &t, ARK_ONE_STEP);
}

int Arkode::linear_system(double t, N_Vector y, N_Vector, SUNMatrix, SUNMatrix, int jok, int* jcur,
                          double gamma, void* self, N_Vector, N_Vector, N_Vector) {
  return static_cast<Arkode*>(static_cast<Library*>(self))->set_matrix(t, y, jok, jcur, gamma);
}

Library::OwnCounts Arkode::own_counts() const {
  OwnCounts own;
  check(ARKStepGetNumSteps(memory(), &own.steps), "ARKStepGetNumSteps");
  check(ARKStepGetNumErrTestFails(memory(), &own.failed_tests), "ARKStepGetNumErrTestFails");
  check(ARKStepGetNumStepSolveFails(memory(), &own.failed_solves), "ARKStepGetNumStepSolveFails");
  if (has_matrix()) {
    check(ARKStepGetNumLinSolvSetups(memory(), &own.setups), "ARKStepGetNumLinSolvSetups");
    check(ARKStepGetNumNonlinSolvIters(memory(), &own.iterations), "ARKStepGetNumNonlinSolvIters");
  }
  check(ARKStepGetNumExpSteps(memory(), &own.limited_steps), "ARKStepGetNumExpSteps");
  return own;
}

Cause Arkode::cause_of(int flag) const { return cause_of_arkode(flag); }

std::string Arkode::flag_name(int flag) const {
  const std::unique_ptr<char, decltype(&std::free)> text(ARKStepGetReturnFlagName(flag), std::free);
  return fmt::format("ARKODE {}", text ? text.get() : "");
}

Cause cause_of_arkode(int flag) {
  static constexpr std::pair<int, Cause> causes[] = {
      {ARK_ERR_FAILURE, Cause::error_test},  {ARK_TOO_MUCH_ACC, Cause::accuracy},
      {ARK_TOO_CLOSE, Cause::end_too_close}, {ARK_CONV_FAILURE, Cause::convergence},
      {ARK_LSETUP_FAIL, Cause::setup},       {ARK_FIRST_RHSFUNC_ERR, Cause::first_force},
      {ARK_RHSFUNC_FAIL, Cause::force},      {ARK_REPTD_RHSFUNC_ERR, Cause::force},
      {ARK_UNREC_RHSFUNC_ERR, Cause::force}, {ARK_INNERSTEP_FAIL, Cause::fast_steps}};
  return cause_in(causes, flag);
}

}  // namespace qddot::sundials
