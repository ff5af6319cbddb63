#include "integrators/sundials/ida_stepper.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace qddot::sundials {

IdaStepper::IdaStepper(SystemRun& run, MakeMatrix make_matrix)
    : Library(run, make_matrix), rate_(clone(y())), memory_(check(IDACreate(context()))) {}

IdaStepper::IdaStepper(SystemRun& run, Index length)
    : Library(run, length), rate_(clone(y())), memory_(check(IDACreate(context()))) {}

void IdaStepper::keep(const Equations& equations) {
  hear_errors(errors_of_ida, ida());
  check(IDAInit(ida(), equations.residual, 0, y(), rate()), "IDAInit");
  check(IDASetUserData(ida(), static_cast<Library*>(this)), "IDASetUserData");
  check(IDASVtolerances(ida(), rtol(), atol()), "IDASVtolerances");
  check(IDASetLinearSolver(ida(), equations.solver, equations.matrix), "IDASetLinearSolver");
  check(IDASetJacFn(ida(), equations.jacobian), "IDASetJacFn");
  if (options().max_order > 0) {
    check(IDASetMaxOrd(ida(), std::min(options().max_order, method().order)), "IDASetMaxOrd");
  }
}

void IdaStepper::set_stop_time(double t_stop) {
  check(IDASetStopTime(ida(), t_stop), "IDASetStopTime");
}

void IdaStepper::note_step() {
  int order = 0;
  check(IDAGetLastOrder(ida(), &order), "IDAGetLastOrder");
  orders_.note(order, counts());
}

void IdaStepper::forget() {
  orders_ = {};
  earlier_ = {};
}

void IdaStepper::start_ida(double t) { check(IDAReInit(ida(), t, y(), rate()), "IDAReInit"); }

void IdaStepper::restart_ida(double t) {
  earlier_ = own_counts();
  start_ida(t);
}

Library::OwnCounts IdaStepper::own_counts() const {
  OwnCounts own;
  check(IDAGetNumSteps(ida(), &own.steps), "IDAGetNumSteps");
  check(IDAGetNumErrTestFails(ida(), &own.failed_tests), "IDAGetNumErrTestFails");
  check(IDAGetNumStepSolveFails(ida(), &own.failed_solves), "IDAGetNumStepSolveFails");
  check(IDAGetNumLinSolvSetups(ida(), &own.setups), "IDAGetNumLinSolvSetups");
  check(IDAGetNumNonlinSolvIters(ida(), &own.iterations), "IDAGetNumNonlinSolvIters");
  own.steps += earlier_.steps;
  own.failed_tests += earlier_.failed_tests;
  own.failed_solves += earlier_.failed_solves;
  own.setups += earlier_.setups;
  own.iterations += earlier_.iterations;
  return own;
}

Cause IdaStepper::cause_of(int flag) const {
  static constexpr std::pair<int, Cause> causes[] = {
      {IDA_ERR_FAIL, Cause::error_test},    {IDA_TOO_MUCH_ACC, Cause::accuracy},
      {IDA_CONV_FAIL, Cause::convergence},  {IDA_NLS_FAIL, Cause::convergence},
      {IDA_LSETUP_FAIL, Cause::setup},      {IDA_FIRST_RES_FAIL, Cause::first_force},
      {IDA_RES_FAIL, Cause::force},         {IDA_REP_RES_ERR, Cause::force},
      {IDA_TOO_CLOSE, Cause::end_too_close}};  // the only cause of this flag that runs meet
  return cause_in(causes, flag);
}

std::string IdaStepper::flag_name(int flag) const {
  const std::unique_ptr<char, decltype(&std::free)> text(IDAGetReturnFlagName(flag), std::free);
  return fmt::format("IDA {}", text ? text.get() : "");
}

}  // namespace qddot::sundials
