// SUNDIALS CVODE: linear multistep methods of variable order k and variable step. With y = (q, v)
// and y' = (v, M^-1 f(q)):
//   BDF             sum_{i=0}^k alpha_i y_{n-i} + h beta_0 y'_n = 0
//   Adams-Moulton   y_n = y_{n-1} + h sum_{i=0}^{k-1} beta_i y'_{n-i}
// The coefficients follow from the sizes of the last steps. BDF has order 1 to 5 and is solved by
// Newton's method. The method cvode_bdf solves with the structured n x n matrix, cvode_bdf_klu the
// stock way with KLU. Adams-Moulton, cvode_adams, has order 1 to 12 and is solved by fixed-point
// iteration. All other settings are CVODE's defaults.
#include <fmt/format.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "integrators/sundials/library.hpp"
#include "integrators/sundials/orders.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

class Cvode : public Library {
 public:
  Cvode(SystemRun& run, int formula, MakeMatrix make_matrix)
      : Library(run, make_matrix), memory_(check(CVodeCreate(formula, context()))) {
    auto* self = static_cast<Library*>(this);
    hear_errors(errors_of_cvode, memory());
    check(CVodeInit(memory(), right_hand_side, 0, y()), "CVodeInit");
    check(CVodeSetUserData(memory(), self), "CVodeSetUserData");
    check(CVodeSVtolerances(memory(), rtol(), atol()), "CVodeSVtolerances");
    check(CVodeSetMaxHnilWarns(memory(), -1), "CVodeSetMaxHnilWarns");
    if (options().max_order > 0) {
      check(CVodeSetMaxOrd(memory(), std::min(options().max_order, method().order)),
            "CVodeSetMaxOrd");
    }
    if (has_matrix()) {
      check(CVodeSetLinearSolver(memory(), matrix().solver(), matrix().matrix()),
            "CVodeSetLinearSolver");
      check(CVodeSetLinSysFn(memory(), linear_system), "CVodeSetLinSysFn");
      check(CVodeSetStabLimDet(memory(), options().stability_detection), "CVodeSetStabLimDet");
    } else {
      fixed_point_.reset(check(SUNNonlinSol_FixedPoint(y(), 0, context())));
      check(CVodeSetNonlinearSolver(memory(), fixed_point_.get()), "CVodeSetNonlinearSolver");
    }
  }

  void set_stop_time(double t_stop) override {
    check(CVodeSetStopTime(memory(), t_stop), "CVodeSetStopTime");
  }

  void note_step() override {
    int order = 0;
    check(CVodeGetLastOrder(memory(), &order), "CVodeGetLastOrder");
    orders_.note(order, counts());
  }

 private:
  void* memory() const { return memory_.get(); }

  void start(const State& state) override {
    load(state);
    orders_ = {};
    check(CVodeReInit(memory(), state.t, y()), "CVodeReInit");
  }

  int take_step(double t_stop, double& t) override {
    return CVode(memory(), t_stop, y(), &t, CV_ONE_STEP);
  }

  static int linear_system(double t, N_Vector y, N_Vector, SUNMatrix, int jok, int* jcur,
                           double gamma, void* self, N_Vector, N_Vector, N_Vector) {
    return static_cast<Cvode*>(static_cast<Library*>(self))->set_matrix(t, y, jok, jcur, gamma);
  }

  OwnCounts own_counts() const override {
    OwnCounts own;
    check(CVodeGetNumSteps(memory(), &own.steps), "CVodeGetNumSteps");
    check(CVodeGetNumErrTestFails(memory(), &own.failed_tests), "CVodeGetNumErrTestFails");
    check(CVodeGetNumStepSolveFails(memory(), &own.failed_solves), "CVodeGetNumStepSolveFails");
    check(CVodeGetNumLinSolvSetups(memory(), &own.setups), "CVodeGetNumLinSolvSetups");
    check(CVodeGetNumNonlinSolvIters(memory(), &own.iterations), "CVodeGetNumNonlinSolvIters");
    if (!has_matrix()) own.setups = own.iterations = 0;
    return own;
  }

  Cause cause_of(int flag) const override {
    static constexpr std::pair<int, Cause> causes[] = {
        {CV_ERR_FAILURE, Cause::error_test},  {CV_TOO_MUCH_ACC, Cause::accuracy},
        {CV_TOO_CLOSE, Cause::end_too_close}, {CV_CONV_FAILURE, Cause::convergence},
        {CV_LSETUP_FAIL, Cause::setup},       {CV_FIRST_RHSFUNC_ERR, Cause::first_force},
        {CV_RHSFUNC_FAIL, Cause::force},      {CV_REPTD_RHSFUNC_ERR, Cause::force},
        {CV_UNREC_RHSFUNC_ERR, Cause::force}};
    return cause_in(causes, flag);
  }

  std::string flag_name(int flag) const override {
    const std::unique_ptr<char, decltype(&std::free)> text(CVodeGetReturnFlagName(flag), std::free);
    return fmt::format("CVODE {}", text ? text.get() : "");
  }

  Orders orders_;
  NonlinearSolver fixed_point_;
  std::unique_ptr<void, FreeMemoryBy<CVodeFree>> memory_;
};

template <MakeMatrix make_matrix>
class Bdf final : public Cvode {
 public:
  explicit Bdf(SystemRun& run) : Cvode(run, CV_BDF, make_matrix) {}
};
class Adams final : public Cvode {
 public:
  explicit Adams(SystemRun& run) : Cvode(run, CV_ADAMS, nullptr) {}
};

template <MakeMatrix make_matrix>
Method bdf(const char* name, const char* solver, const char* stock_of = "") {
  return {.name = name,
          .summary = fmt::format("SUNDIALS CVODE, adaptive BDF of order 1 to 5, {}", solver),
          .source = "Hindmarsh et al., SUNDIALS, ACM TOMS 31:3 (2005) 363-396, section 2.1",
          .order = 5,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::stiffness},
          .takes = SetOf<Option>{Option::max_order, Option::stability_detection}.with(
              Option::solver, make_matrix == make_structured),
          .stock_of = stock_of,
          .damped = Damped::by_any,
          .make = create_steps<Bdf<make_matrix>>};
}

}  // namespace

Method cvode_bdf() { return bdf<make_structured>("cvode_bdf", "n x n solves"); }
Method cvode_bdf_klu() { return bdf<make_klu>("cvode_bdf_klu", "stock KLU", "cvode_bdf"); }

Method cvode_adams() {
  return {.name = "cvode_adams",
          .summary =
              "SUNDIALS CVODE, adaptive Adams-Moulton of order 1 to 12 by fixed-point "
              "iteration",
          .source = "Hindmarsh et al., SUNDIALS, ACM TOMS 31:3 (2005) 363-396, section 2.1",
          .order = 12,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .takes = {Option::max_order},
          .make = create_steps<Adams>};
}

}  // namespace qddot::registered
