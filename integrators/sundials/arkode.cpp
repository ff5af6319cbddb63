// SUNDIALS ARKODE's adaptive diagonally implicit Runge-Kutta methods on y' = (v, M^-1 f(q)), the
// stock way: Newton with KLU on the analytic Jacobian [[0, I], [M^-1 K, 0]]. Orders and error
// estimates are those of the named table; everything that is not set below is ARKODE's default.
// (Hindmarsh et al., ACM TOMS 31:3 (2005) 363-396; Reynolds et al., ARXIV 2205.14077.)
#include <arkode/arkode_arkstep.h>
#include <fmt/format.h>

#include "integrators/registry.hpp"
#include "integrators/sundials/support.hpp"

namespace qddot {
namespace {

using sundials::check;
using sundials::Halves;

struct FreeArkode {
  void operator()(void* memory) const { ARKStepFree(&memory); }
};

class Dirk : public sundials::Stock {
 public:
  Dirk(const Method& method, const System& system, const Knobs& knobs, const char* table)
      : Stock(method, system, knobs) {
    N_VConst(0, y());
    memory_.reset(check(ARKStepCreate(nullptr, right_hand_side, 0, y(), context())));
    check(ARKStepSetUserData(ark(), this), "ARKStepSetUserData");
    check(ARKStepSetErrHandlerFn(ark(), keep_message, this), "ARKStepSetErrHandlerFn");
    check(ARKStepSetTableName(ark(), table, "ARKODE_ERK_NONE"), "ARKStepSetTableName");
    check(ARKStepSStolerances(ark(), rtol(), atol()), "ARKStepSStolerances");
    check(ARKStepSetLinearSolver(ark(), linear_solver(), matrix()), "ARKStepSetLinearSolver");
    check(ARKStepSetJacFn(ark(), jacobian), "ARKStepSetJacFn");
    // ARKODE trusts Newton's rate of convergence as it was at the best earlier solve, lowered by
    // 0.3 each time. On vibrations, where the factors are up to 20 % off in gamma, it then stops
    // after one iteration: errors of 1e4 and more times the tolerance. With 1 for 0.3 the rate is
    // never taken for better than none, and the correction itself has to be below the tolerance.
    check(ARKStepSetNonlinCRDown(ark(), 1), "ARKStepSetNonlinCRDown");
    check(ARKStepSetNonlinConvCoef(ark(), 1), "ARKStepSetNonlinConvCoef");
    check(ARKStepSetMaxHnilWarns(ark(), -1), "ARKStepSetMaxHnilWarns");
  }

 private:
  void* ark() const { return memory_.get(); }

  void start(const State& state) override {
    load(state);
    per_mass_ = system().mass().cwiseInverse();
    check(ARKStepReInit(ark(), nullptr, right_hand_side, state.t, y()), "ARKStepReInit");
  }

  void set_stop_time(double t_stop) override {
    check(ARKStepSetStopTime(ark(), t_stop), "ARKStepSetStopTime");
  }

  int take_step(double t_stop, double& t) override {
    return ARKStepEvolve(ark(), t_stop, y(), &t, ARK_ONE_STEP);
  }

  static int right_hand_side(realtype, N_Vector y, N_Vector ydot, void* user) {
    auto& self = *static_cast<Dirk*>(user);
    return self.guarded([&] {
      const Halves at(y);
      Halves rate(ydot);
      rate.q = at.v;
      rate.v = self.per_mass_.cwiseProduct(self.force_at(at.q));
      return std::isfinite(rate.v.sum());
    });
  }

  static int jacobian(realtype, N_Vector y, N_Vector, SUNMatrix jacobian, void* user, N_Vector,
                      N_Vector, N_Vector) {
    auto& self = *static_cast<Dirk*>(user);
    return self.guarded([&] {
      self.fill(jacobian, Halves(y).q, 0, 1, self.per_mass_, Vec::Zero(self.system().size()));
      return true;
    });
  }

  void collect_counts() override {
    long steps = 0, failed_tests = 0, failed_solves = 0, setups = 0, iterations = 0;
    check(ARKStepGetNumSteps(ark(), &steps), "ARKStepGetNumSteps");
    check(ARKStepGetNumErrTestFails(ark(), &failed_tests), "ARKStepGetNumErrTestFails");
    check(ARKStepGetNumStepSolveFails(ark(), &failed_solves), "ARKStepGetNumStepSolveFails");
    check(ARKStepGetNumLinSolvSetups(ark(), &setups), "ARKStepGetNumLinSolvSetups");
    check(ARKStepGetNumNonlinSolvIters(ark(), &iterations), "ARKStepGetNumNonlinSolvIters");
    set_counts({steps, failed_tests, failed_solves, setups, iterations});
  }

  Outcome outcome_of(int flag) const override {
    switch (flag) {
      case ARK_ERR_FAILURE:
      case ARK_TOO_MUCH_ACC:
      case ARK_TOO_CLOSE:
        return Outcome::step_too_small;
      case ARK_CONV_FAILURE:
        return Outcome::newton_failed;
      case ARK_LSETUP_FAIL:
        return Outcome::indefinite_matrix;
      case ARK_RHSFUNC_FAIL:
      case ARK_FIRST_RHSFUNC_ERR:
      case ARK_REPTD_RHSFUNC_ERR:
      case ARK_UNREC_RHSFUNC_ERR:
        return Outcome::not_finite;
      default:
        return Outcome::solver_failed;
    }
  }

  std::string flag_name(int flag) const override {
    const std::unique_ptr<char, decltype(&std::free)> text(ARKStepGetReturnFlagName(flag),
                                                           std::free);
    return fmt::format("ARKODE {}", text ? text.get() : "");
  }

  std::unique_ptr<void, FreeArkode> memory_;
  Vec per_mass_;  // 1/m
};

struct Table {
  int order;
  const char* name;
  const char* source;
};
constexpr std::array<Table, 4> tables = {{
    {2, "ARKODE_SDIRK_2_1_2", "SUNDIALS 6.4.1 ARKODE guide, table SDIRK_2_1_2"},
    {3, "ARKODE_KVAERNO_4_2_3", "Kvaerno, BIT Numerical Mathematics 44 (2004) 489-502"},
    {4, "ARKODE_SDIRK_5_3_4", "Hairer and Wanner, Solving ODEs II, table IV.6.5, SDIRK4(3)5"},
    {5, "ARKODE_ESDIRK547L2SA_7_4_5",
     "Kennedy and Carpenter, Applied Numerical Mathematics 146 (2019), ESDIRK5(4)7L[2]SA"},
}};

template <std::size_t which>
Method dirk() {
  constexpr Table table = tables[which];
  return {.name = fmt::format("arkode_dirk{}", table.order),
          .summary = fmt::format("SUNDIALS ARKODE, adaptive DIRK of order {}, {}, stock KLU",
                                 table.order, table.name),
          .source = table.source,
          .order = table.order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .implicit = true,
          .needs_stiffness = true,
          .make = [](const Method& method, const System& system,
                     const Knobs& knobs) -> std::unique_ptr<Integrator> {
            return std::make_unique<Dirk>(method, system, knobs, tables[which].name);
          }};
}

}  // namespace

Method arkode_dirk2() { return dirk<0>(); }
Method arkode_dirk3() { return dirk<1>(); }
Method arkode_dirk4() { return dirk<2>(); }
Method arkode_dirk5() { return dirk<3>(); }

}  // namespace qddot
