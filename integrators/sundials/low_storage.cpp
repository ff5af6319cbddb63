// ARKODE's adaptive Runge-Kutta methods that preserve strong stability: averages of steps of
// explicit Euler. However many stages there are, they need two or three vectors. With y = (q, v),
// F(y) = (v, M^-1 f(q)), E(Y) = Y + h F(Y)/c, and E^k for k such steps:
//   order 3, 4 stages, c = 2:    y_{n+1} = E((2 y_n + E^3(y_n))/3)
//   order 4, 10 stages, c = 6:   Y = E^5(y_n),   Z = (y_n + 9 Y)/25
//                                y_{n+1} = Z + 3/5 E^5(15 Z - 5 Y)
// Other averages of the same stages estimate the error, and the next step size follows from it.
//
// If the system has a K, steps are held to h <= y/w_max, as those of arkode_erk, with the limit y
// of these formulas on vibrations. ARKODE's family of order 2 is left out: with its best number of
// stages on vibrations it is Heun's method, arkode_erk2.
#include "integrators/sundials/low_storage.hpp"

#include <fmt/format.h>

#include "integrators/sundials/arkode_stepper.hpp"
#include "integrators/sundials/imaginary_stability.hpp"
#include "qddot/integrators/registry.hpp"

#if QDDOT_SUNDIALS >= 70200
#include <arkode/arkode_lsrkstep.h>
#endif

namespace qddot::registered {
namespace {

using namespace sundials;

#if QDDOT_SUNDIALS >= 70200

template <ARKODE_LSRKMethodType which, int stages, auto growth>
class LowStorage final : public ArkodeStepper {
 public:
  explicit LowStorage(SystemRun& run) : ArkodeStepper(run, nullptr, run.system()) {
    keep(LSRKStepCreateSSP(rate_or_stop, 0, y(), context()));
    set_tolerances();
    check(LSRKStepSetSSPMethod(memory(), which), "LSRKStepSetSSPMethod");
    check(LSRKStepSetNumSSPStages(memory(), stages), "LSRKStepSetNumSSPStages");
    limit_steps(system(), imaginary_stability(growth, stages));
  }

 private:
  int restart(double t) override { return LSRKStepReInitSSP(memory(), rate_or_stop, t, y()); }

  // Ends the run where a rate is no number. From a shorter step after that, SUNDIALS 7.9 takes a
  // wrong first rate, whose vector later stages have used.
  static int rate_or_stop(double t, N_Vector y, N_Vector rate, void* self) {
    return right_hand_side(t, y, rate, self) == 0 ? 0 : -1;
  }
};
constexpr MakeStepper make_ssp3 = create_steps<LowStorage<ARKODE_LSRK_SSP_S_3, 4, growth_of_ssp3>>;
constexpr MakeStepper make_ssp4 =
    create_steps<LowStorage<ARKODE_LSRK_SSP_10_4, 10, growth_of_ssp4>>;

#else

constexpr MakeStepper make_ssp3 = nullptr, make_ssp4 = nullptr;

#endif

Method low_storage(int order, const char* formula, const char* source, MakeStepper make) {
  return {.name = fmt::format("arkode_ssp{}", order),
          .summary = fmt::format("SUNDIALS ARKODE, adaptive explicit of order {}, strong stability "
                                 "in little storage, {}, steps held to 1/w_max",
                                 order, formula),
          .source = source,
          .order = order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::bounds_steps},
          .needs_sundials = 70200,
          .make = make};
}

}  // namespace

Method arkode_ssp3() {
  return low_storage(3, "ARKODE_LSRK_SSP_S_3 of 4 stages",
                     "Kraaijevanger, BIT 31:3 (1991) 482-528; Fekete, Conde and Shadid, J. "
                     "Computational and Applied Mathematics 412 (2022) 114325",
                     make_ssp3);
}
Method arkode_ssp4() {
  return low_storage(4, "ARKODE_LSRK_SSP_10_4",
                     "Ketcheson, SIAM J. Scientific Computing 30:4 (2008) 2113-2136; Fekete, Conde "
                     "and Shadid, J. Computational and Applied Mathematics 412 (2022) 114325",
                     make_ssp4);
}

}  // namespace qddot::registered
