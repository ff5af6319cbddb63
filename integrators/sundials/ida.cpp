// SUNDIALS IDA: variable-order (1 to 5), variable-step BDF in fixed-leading-coefficient form on
//   F(y, y') = (q' - v, M v' - f(q)),
// the stock way: Newton with KLU on dF/dy + c dF/dy' = [[c I, -I], [-K, c M]]. Everything that is
// not set here is left at IDA's default. (Hindmarsh et al., ACM TOMS 31:3 (2005) 363-396.)
#include <fmt/format.h>
#include <ida/ida.h>

#include "integrators/registry.hpp"
#include "integrators/sundials/support.hpp"

namespace qddot {
namespace {

using sundials::check;
using sundials::Halves;

struct FreeIda {
  void operator()(void* memory) const { IDAFree(&memory); }
};

class Ida final : public sundials::Stock {
 public:
  Ida(const Method& method, const System& system, const Knobs& knobs)
      : Stock(method, system, knobs), rate_(check(N_VClone(y()))) {
    N_VConst(0, y());
    N_VConst(0, rate_.get());
    memory_.reset(check(IDACreate(context())));
    check(IDASetErrHandlerFn(ida(), keep_message, this), "IDASetErrHandlerFn");
    check(IDAInit(ida(), residual, 0, y(), rate_.get()), "IDAInit");
    check(IDASetUserData(ida(), this), "IDASetUserData");
    check(IDASStolerances(ida(), rtol(), atol()), "IDASStolerances");
    check(IDASetLinearSolver(ida(), linear_solver(), matrix()), "IDASetLinearSolver");
    check(IDASetJacFn(ida(), jacobian), "IDASetJacFn");
  }

 private:
  void* ida() const { return memory_.get(); }

  void start(const State& state) override {
    load(state);
    Halves rate(rate_.get());
    rate.q = state.v;
    rate.v = force_at(Halves(y()).q).cwiseQuotient(system().mass());  // consistent: F = 0
    check(IDAReInit(ida(), state.t, y(), rate_.get()), "IDAReInit");
  }

  void set_stop_time(double t_stop) override {
    check(IDASetStopTime(ida(), t_stop), "IDASetStopTime");
  }

  int take_step(double t_stop, double& t) override {
    return IDASolve(ida(), t_stop, &t, y(), rate_.get(), IDA_ONE_STEP);
  }

  static int residual(realtype, N_Vector y, N_Vector rate, N_Vector residual, void* user) {
    auto& self = *static_cast<Ida*>(user);
    return self.guarded([&] {
      const Halves at(y), change(rate);
      Halves out(residual);
      out.q = change.q - at.v;
      out.v = self.system().mass().cwiseProduct(change.v) - self.force_at(at.q);
      return std::isfinite(out.v.sum());
    });
  }

  static int jacobian(realtype, realtype c, N_Vector y, N_Vector, N_Vector, SUNMatrix jacobian,
                      void* user, N_Vector, N_Vector, N_Vector) {
    auto& self = *static_cast<Ida*>(user);
    return self.guarded([&] {
      const Index n = self.system().size();
      self.fill(jacobian, Halves(y).q, c, -1, Vec::Constant(n, -1), c * self.system().mass());
      return true;
    });
  }

  void collect_counts() override {
    long steps = 0, failed_tests = 0, failed_solves = 0, setups = 0, iterations = 0;
    check(IDAGetNumSteps(ida(), &steps), "IDAGetNumSteps");
    check(IDAGetNumErrTestFails(ida(), &failed_tests), "IDAGetNumErrTestFails");
    check(IDAGetNumStepSolveFails(ida(), &failed_solves), "IDAGetNumStepSolveFails");
    check(IDAGetNumLinSolvSetups(ida(), &setups), "IDAGetNumLinSolvSetups");
    check(IDAGetNumNonlinSolvIters(ida(), &iterations), "IDAGetNumNonlinSolvIters");
    set_counts({steps, failed_tests, failed_solves, setups, iterations});
  }

  Outcome outcome_of(int flag) const override {
    switch (flag) {
      case IDA_ERR_FAIL:
      case IDA_TOO_MUCH_ACC:
        return Outcome::step_too_small;
      case IDA_CONV_FAIL:
      case IDA_NLS_FAIL:
        return Outcome::newton_failed;
      case IDA_LSETUP_FAIL:
        return Outcome::indefinite_matrix;
      case IDA_RES_FAIL:
      case IDA_REP_RES_ERR:
      case IDA_FIRST_RES_FAIL:
        return Outcome::not_finite;
      default:
        return Outcome::solver_failed;
    }
  }

  std::string flag_name(int flag) const override {
    const std::unique_ptr<char, decltype(&std::free)> text(IDAGetReturnFlagName(flag), std::free);
    return text ? text.get() : "IDA";
  }

  sundials::Vector rate_;  // y'
  std::unique_ptr<void, FreeIda> memory_;
};

}  // namespace

Method ida() {
  return {.name = "ida",
          .summary = "SUNDIALS IDA, adaptive BDF of order 1 to 5 in residual form, stock KLU",
          .source = "Hindmarsh et al., SUNDIALS, ACM TOMS 31:3 (2005) 363-396",
          .order = 5,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .implicit = true,
          .needs_stiffness = true,
          .make = create<Ida>};
}

}  // namespace qddot
