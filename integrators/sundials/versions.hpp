#pragma once

// The differences between SUNDIALS 6.4 and 7.x. The other files are written for the newest: here,
// its names are given to the functions of older versions.

#include <cstdio>  // missing in the headers of ARKODE 6

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <arkode/arkode_mristep.h>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>

#include "integrators/sundials/version.hpp"

namespace qddot::sundials {

// Receives the words of an error of a library, for the object `self`.
using HearErrors = void (*)(const char* words, void* self) noexcept;

#if QDDOT_SUNDIALS < 70000

inline constexpr int SUN_SUCCESS = 0;
inline constexpr int SUN_ERR_EXT_FAIL = SUNLS_PACKAGE_FAIL_UNREC;
inline constexpr void* SUN_COMM_NULL = nullptr;

// Each library has an error handler of its own.
template <HearErrors hear>
void hear_old(int, const char*, const char*, char* words, void* self) {
  hear(words, self);
}
template <HearErrors hear, class Set>
int set_error_handler(Set set, void* memory, SUNContext, void* self) {
  return set(memory, hear_old<hear>, self);
}
inline constexpr auto errors_of_arkstep = ARKStepSetErrHandlerFn;
inline constexpr auto errors_of_erkstep = ERKStepSetErrHandlerFn;
inline constexpr auto errors_of_mristep = MRIStepSetErrHandlerFn;
inline constexpr auto errors_of_cvode = CVodeSetErrHandlerFn;
inline constexpr auto errors_of_ida = IDASetErrHandlerFn;

#else

// All libraries of a context have one.
template <HearErrors hear>
void hear_new(int, const char*, const char*, const char* words, SUNErrCode, void* self,
              SUNContext) {
  hear(words, self);
}
template <HearErrors hear, class Set>
int set_error_handler(Set, void*, SUNContext context, void* self) {
  const int flag = SUNContext_ClearErrHandlers(context);  // SUNDIALS' own prints
  return flag < 0 ? flag : SUNContext_PushErrHandler(context, hear_new<hear>, self);
}
inline constexpr auto errors_of_arkstep = nullptr;
inline constexpr auto errors_of_erkstep = nullptr;
inline constexpr auto errors_of_mristep = nullptr;
inline constexpr auto errors_of_cvode = nullptr;
inline constexpr auto errors_of_ida = nullptr;

#endif

// From 7.1 on, all steppers of ARKODE share their functions.
#if QDDOT_SUNDIALS < 70100
inline constexpr auto ARKodeEvolve = ARKStepEvolve;
inline constexpr auto ARKodeGetNumErrTestFails = ARKStepGetNumErrTestFails;
inline constexpr auto ARKodeGetNumExpSteps = ARKStepGetNumExpSteps;
inline constexpr auto ARKodeGetNumLinSolvSetups = ARKStepGetNumLinSolvSetups;
inline constexpr auto ARKodeGetNumNonlinSolvIters = ARKStepGetNumNonlinSolvIters;
inline constexpr auto ARKodeGetNumStepSolveFails = ARKStepGetNumStepSolveFails;
inline constexpr auto ARKodeGetNumSteps = ARKStepGetNumSteps;
inline constexpr auto ARKodeGetReturnFlagName = ARKStepGetReturnFlagName;
inline constexpr auto ARKodeSVtolerances = ARKStepSVtolerances;
inline constexpr auto ARKodeSetCFLFraction = ARKStepSetCFLFraction;
inline constexpr auto ARKodeSetDeduceImplicitRhs = ARKStepSetDeduceImplicitRhs;
inline constexpr auto ARKodeSetFixedStep = ARKStepSetFixedStep;
inline constexpr auto ARKodeSetInterpolantDegree = ARKStepSetInterpolantDegree;
inline constexpr auto ARKodeSetJacEvalFrequency = ARKStepSetJacEvalFrequency;
inline constexpr auto ARKodeSetLSetupFrequency = ARKStepSetLSetupFrequency;
inline constexpr auto ARKodeSetLinSysFn = ARKStepSetLinSysFn;
inline constexpr auto ARKodeSetLinearSolver = ARKStepSetLinearSolver;
inline constexpr auto ARKodeSetMaxErrTestFails = ARKStepSetMaxErrTestFails;
inline constexpr auto ARKodeSetMaxHnilWarns = ARKStepSetMaxHnilWarns;
inline constexpr auto ARKodeSetMaxNumSteps = ARKStepSetMaxNumSteps;
inline constexpr auto ARKodeSetNonlinearSolver = ARKStepSetNonlinearSolver;
inline constexpr auto ARKodeSetPredictorMethod = ARKStepSetPredictorMethod;
inline constexpr auto ARKodeSetStabilityFn = ARKStepSetStabilityFn;
inline constexpr auto ARKodeSetStopTime = ARKStepSetStopTime;
inline constexpr auto ARKodeSetUserData = ARKStepSetUserData;
inline constexpr auto set_postprocess_step = ARKStepSetPostprocessStepFn;
inline constexpr auto evolve_erk = ERKStepEvolve;
inline constexpr auto get_erk_steps = ERKStepGetNumSteps;
inline constexpr auto set_erk_max_steps = ERKStepSetMaxNumSteps;
inline constexpr auto set_erk_order = ERKStepSetOrder;
inline constexpr auto set_erk_stop_time = ERKStepSetStopTime;
inline constexpr auto set_erk_tolerances = ERKStepSVtolerances;
inline constexpr auto set_erk_user_data = ERKStepSetUserData;
inline constexpr auto evolve_mri = MRIStepEvolve;
inline constexpr auto get_mri_steps = MRIStepGetNumSteps;
inline constexpr auto set_mri_step = MRIStepSetFixedStep;
inline constexpr auto set_mri_user_data = MRIStepSetUserData;
inline constexpr auto ARKodeFree = ARKStepFree;
inline constexpr auto free_erk = ERKStepFree;
inline constexpr auto free_mri = MRIStepFree;
#else
inline constexpr auto set_postprocess_step = ARKodeSetPostprocessStepFn;
inline constexpr auto evolve_erk = ARKodeEvolve;
inline constexpr auto get_erk_steps = ARKodeGetNumSteps;
inline constexpr auto set_erk_max_steps = ARKodeSetMaxNumSteps;
inline constexpr auto set_erk_order = ARKodeSetOrder;
inline constexpr auto set_erk_stop_time = ARKodeSetStopTime;
inline constexpr auto set_erk_tolerances = ARKodeSVtolerances;
inline constexpr auto set_erk_user_data = ARKodeSetUserData;
inline constexpr auto evolve_mri = ARKodeEvolve;
inline constexpr auto get_mri_steps = ARKodeGetNumSteps;
inline constexpr auto set_mri_step = ARKodeSetFixedStep;
inline constexpr auto set_mri_user_data = ARKodeSetUserData;
inline constexpr auto free_erk = ARKodeFree;
inline constexpr auto free_mri = ARKodeFree;
#endif

// Older versions of IDA say so by another flag.
#ifndef IDA_TOO_CLOSE
inline constexpr int IDA_TOO_CLOSE = IDA_ILL_INPUT;
#endif

#if QDDOT_SUNDIALS < 70200
inline constexpr auto ARKodeCreateMRIStepInnerStepper = ARKStepCreateMRIStepInnerStepper;
#endif

}  // namespace qddot::sundials
