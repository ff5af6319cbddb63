// ARKODE's symplectic partitioned Runge-Kutta methods of constant step: kicks and drifts by turns,
// with the coefficients a_i and b_i of the named table. From q_0 = q_n and v_0 = v_n,
//   v_i = v_{i-1} + h b_i M^-1 f(q_{i-1})
//   q_i = q_{i-1} + h a_i v_i,   i = 1 ... s
//   q_{n+1} = q_s,   v_{n+1} = v_s
// ARKODE evaluates f in all s stages, also where b_i is zero. A force that depends on time would be
// taken at t_n + (b_1 + ... + b_i) h, which is not the time of q_{i-1}: the order falls to 1. The
// table of order 2 is that of position_verlet, so that SUNDIALS' run of a formula can be laid over
// a hand-written one.
#include <fmt/format.h>

#include "integrators/sundials/arkode_stepper.hpp"
#include "qddot/integrators/registry.hpp"

#if QDDOT_SUNDIALS >= 70100
#include <arkode/arkode_sprkstep.h>
#endif

namespace qddot::registered {
namespace {

using namespace sundials;

struct SplitTable {
  int order;
  const char* name;  // ARKODE's
  // The largest h w at which q'' = -w^2 q does not grow: where the trace of the product of its
  // kicks and drifts first leaves [-2, 2].
  double limit;
  bool is_symmetric;
  const char* source;
};
constexpr const char* mclachlan =
    "McLachlan and Atela, Nonlinearity 5:2 (1992) 541-562; McLachlan, SIAM J. Scientific "
    "Computing 16:1 (1995) 151-168";
constexpr SplitTable split_tables[] = {
    {2, "ARKODE_SPRK_LEAPFROG_2_2", 2, true,
     "Hairer, Lubich and Wanner, Geometric Numerical Integration, section I.1.4"},
    {3, "ARKODE_SPRK_MCLACHLAN_3_3", 4.5200895183984136, false, mclachlan},
    {4, "ARKODE_SPRK_MCLACHLAN_4_4", 3.0389488778951166, false, mclachlan},
    {5, "ARKODE_SPRK_MCLACHLAN_5_6", 3.0624976839832323, false, mclachlan},
    {6, "ARKODE_SPRK_YOSHIDA_6_8", 2.2690579963976605, true,
     "Yoshida, Physics Letters A 150 (1990) 262-268"},
    {8, "ARKODE_SPRK_SUZUKI_UMENO_8_16", 3.3932342684641497, true,
     "Suzuki and Umeno, Computer Simulation Studies in Condensed-Matter Physics VI (1993) 74-86"},
    {10, "ARKODE_SPRK_SOFRONIOU_10_36", 3.1410818628973955, true,
     "Sofroniou and Spaletta, Optimization Methods and Software 20 (2005) 597-613"}};

#if QDDOT_SUNDIALS >= 70100

template <int which>
class Sprk final : public ArkodeStepper {
 public:
  explicit Sprk(SystemRun& run) : ArkodeStepper(run, nullptr, run.system()) {
    keep(SPRKStepCreate(kick, drift, 0, y(), context()));
    check(SPRKStepSetMethodName(memory(), split_tables[which].name), "SPRKStepSetMethodName");
  }

 private:
  // SPRKStepReInit of SUNDIALS 7.1 follows a null pointer.
  int restart(double t) override { return ARKodeReset(memory(), t, y()); }

  static int kick(double t, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<Sprk*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const bool is_finite = self.set_rate(self.system(), t, y, rate);
      Halves(rate).q.setZero();
      // Some versions multiply by a b_i of zero what an earlier run has left here.
      if (!is_finite) Halves(rate).v.setZero();
      return is_finite;
    });
  }
  static int drift(double, N_Vector y, N_Vector rate, void*) {
    Halves change(rate);
    change.q = Halves(y).v;
    change.v.setZero();
    return 0;
  }
};
template <int which>
constexpr MakeStepper make_sprk = create_steps<Sprk<which>>;

#else

template <int>
constexpr MakeStepper make_sprk = nullptr;

#endif

template <int which>
Method sprk() {
  const SplitTable& table = split_tables[which];
  return {.name = fmt::format("arkode_sprk{}", table.order),
          .summary = fmt::format("SUNDIALS ARKODE, symplectic kicks and drifts of order {}, {}",
                                 table.order, table.name),
          .source = table.source,
          .order = table.order,
          .family = Family::sundials,
          .stability_limit = table.limit,
          .traits = SetOf<Trait>{Trait::symplectic}.with(Trait::reversible, table.is_symmetric),
          .needs = {Need::conservative, Need::autonomous},
          .needs_sundials = 70100,
          .why_not_damped = "its kicks are for forces of positions",
          .make = make_sprk<which>};
}

}  // namespace

Method arkode_sprk2() { return sprk<0>(); }
Method arkode_sprk3() { return sprk<1>(); }
Method arkode_sprk4() { return sprk<2>(); }
Method arkode_sprk5() { return sprk<3>(); }
Method arkode_sprk6() { return sprk<4>(); }
Method arkode_sprk8() { return sprk<5>(); }
Method arkode_sprk10() { return sprk<6>(); }

}  // namespace qddot::registered
