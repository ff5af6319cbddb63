#include "integrators/sundials/arkode_stepper.hpp"

#include <fmt/format.h>

namespace qddot::sundials {
namespace {

// ARKODE takes its own fraction of the bound, which must be below 1.
constexpr double fraction = 0.99;

// Refusals of one step before ARKODE gives up.
constexpr int most_refusals = 50;

}  // namespace

ArkodeStepper::ArkodeStepper(SystemRun& run, MakeMatrix make_matrix, const System& implicit_part)
    : Library(run, make_matrix, implicit_part) {}

void ArkodeStepper::keep(void* made) {
  memory_.reset(check(made));
  check(ARKodeSetUserData(memory(), static_cast<Library*>(this)), "ARKodeSetUserData");
  hear_errors(errors_of_arkstep, memory());
}

void ArkodeStepper::set_tolerances() {
  check(ARKodeSVtolerances(memory(), rtol(), atol()), "ARKodeSVtolerances");
  check(ARKodeSetMaxHnilWarns(memory(), -1), "ARKodeSetMaxHnilWarns");
  // A long step over a jump of the force, as of a spring that turns over, is refused more often
  // than the 7 times that ARKODE allows.
  check(ARKodeSetMaxErrTestFails(memory(), most_refusals), "ARKodeSetMaxErrTestFails");
}

void ArkodeStepper::limit_steps(const System& part, double y) {
  limit_.emplace(Limit{part, y, Vec(part.size()), RenewedBound(part)});
  check(ARKodeSetStabilityFn(memory(), stable_step, this), "ARKodeSetStabilityFn");
  check(ARKodeSetCFLFraction(memory(), fraction), "ARKodeSetCFLFraction");
}

int ArkodeStepper::stable_step(N_Vector y, double t, double* h, void* user) {
  auto& self = *static_cast<ArkodeStepper*>(user);
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

void ArkodeStepper::start(const State& state) {
  load(state);
  if (limit_) {
    limit_->calls = 0;
    limit_->w_max.start();
  }
  check(restart(state.t), "the start of ARKODE");
}

void ArkodeStepper::set_stop_time(double t_stop) {
  check(ARKodeSetStopTime(memory(), t_stop), "ARKodeSetStopTime");
}

void ArkodeStepper::set_step_size(double h) {
  check(ARKodeSetFixedStep(memory(), h), "ARKodeSetFixedStep");
}

int ArkodeStepper::take_step(double t_stop, double& t) {
  return ARKodeEvolve(memory(), t_stop, y(), &t, ARK_ONE_STEP);
}

Library::OwnCounts ArkodeStepper::own_counts() const {
  OwnCounts own;
  check(ARKodeGetNumSteps(memory(), &own.steps), "ARKodeGetNumSteps");
  check(ARKodeGetNumErrTestFails(memory(), &own.failed_tests), "ARKodeGetNumErrTestFails");
  check(ARKodeGetNumStepSolveFails(memory(), &own.failed_solves), "ARKodeGetNumStepSolveFails");
  if (has_matrix()) {
    check(ARKodeGetNumLinSolvSetups(memory(), &own.setups), "ARKodeGetNumLinSolvSetups");
    check(ARKodeGetNumNonlinSolvIters(memory(), &own.iterations), "ARKodeGetNumNonlinSolvIters");
  }
  check(ARKodeGetNumExpSteps(memory(), &own.limited_steps), "ARKodeGetNumExpSteps");
  return own;
}

Cause ArkodeStepper::cause_of(int flag) const { return cause_of_arkode(flag); }

std::string ArkodeStepper::flag_name(int flag) const {
  const std::unique_ptr<char, decltype(&std::free)> text(ARKodeGetReturnFlagName(flag), std::free);
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
