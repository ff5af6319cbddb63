// ARKODE's multirate infinitesimal steps for scenes that name their stiff springs. With y = (q, v)
// and y' = g(y) + e(y):
//   g = (v, M^-1 f_stiff(q)) fast,   e = (0, M^-1 f_soft(q)) slow
//   Y_1 = y_n;   Y_{i+1} is where y' = g(y) + sum_{j<=i} p_ij(t) e(Y_j) leads from Y_i,
//                from t_n + c_i h to t_n + c_{i+1} h;   y_{n+1} = Y_{s+1}
// The soft forces are evaluated at the s stages of a step h only. Between the stages stiff forces
// move the nodes, and polynomials p_ij of the named table add the soft ones.
//
// This inner motion takes m steps of h/m, by an explicit method of the same order. The number m is
// w_max(stiff)/w_max(soft), so that both step sizes are as fine beside the periods that they
// resolve.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "integrators/sundials/arkode.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

struct Pair {
  int order;
  ARKODE_MRITableID slow;
  ARKODE_ERKTableID fast;
  const char* name;
};
constexpr Pair pairs[] = {
    {3, ARKODE_MRI_GARK_ERK33a, ARKODE_BOGACKI_SHAMPINE_4_2_3, "MRI_GARK_ERK33a"},
    {4, ARKODE_MRI_GARK_ERK45a, ARKODE_ZONNEVELD_5_3_4, "MRI_GARK_ERK45a"}};

// The most fast steps, far above the ratio of any two springs.
constexpr double most_fast_steps = 1e6;

struct FreeInner {
  void operator()(MRIStepInnerStepper stepper) const { MRIStepInnerStepper_Free(&stepper); }
};
using InnerStepper = std::unique_ptr<_MRIStepInnerStepper, FreeInner>;

template <int order>
class Mri final : public Library {
  static constexpr Pair pair = pairs[order - 3];

 public:
  explicit Mri(SystemRun& run)
      : Library(run, nullptr),
        stiff_(stiff_of(run.system())),
        soft_(soft_of(run.system())),
        fast_(check(ARKStepCreate(stiff_rate, nullptr, 0, y(), context()))) {
    auto* self = static_cast<Library*>(this);
    const ButcherTable table(check(ARKodeButcherTable_LoadERK(pair.fast)));
    check(ARKodeSetUserData(fast_.get(), self), "ARKodeSetUserData");
    hear_errors(errors_of_arkstep, fast_.get());
    check(ARKStepSetTables(fast_.get(), table->q, table->p, nullptr, table.get()),
          "ARKStepSetTables");
    check(ARKodeSetMaxNumSteps(fast_.get(), -1), "ARKodeSetMaxNumSteps");
    MRIStepInnerStepper inner = nullptr;
    check(ARKodeCreateMRIStepInnerStepper(fast_.get(), &inner), "ARKodeCreateMRIStepInnerStepper");
    inner_.reset(inner);
    slow_.reset(check(MRIStepCreate(soft_rate, nullptr, 0, y(), inner, context())));
    check(set_mri_user_data(slow_.get(), self), "set_mri_user_data");
    hear_errors(errors_of_mristep, slow_.get());
    const Coupling coupling(check(MRIStepCoupling_LoadTable(pair.slow)));
    check(MRIStepSetCoupling(slow_.get(), coupling.get()), "MRIStepSetCoupling");
  }

  void set_stop_time(double) override {}

 private:
  using Coupling = std::unique_ptr<MRIStepCouplingMem, FreeBy<MRIStepCoupling_Free>>;

  void start(const State& state) override {
    load(state);
    const double stiff = frequency_bound(stiff_, state.q);
    const double soft = frequency_bound(soft_, state.q);
    fast_steps_ = soft > 0 ? std::clamp(std::ceil(stiff / soft), 1.0, most_fast_steps) : 1;
    check(ARKStepReInit(fast_.get(), stiff_rate, nullptr, state.t, y()), "ARKStepReInit");
    check(MRIStepReInit(slow_.get(), soft_rate, nullptr, state.t, y()), "MRIStepReInit");
  }

  void set_step_size(double h) override {
    fast_step_ = h / fast_steps_;
    check(ARKodeSetFixedStep(fast_.get(), fast_step_), "ARKodeSetFixedStep");
    check(set_mri_step(slow_.get(), h), "set_mri_step");
  }

  int take_step(double t_stop, double& t) override {
    // Small steps below the spacing of times would never end.
    const double furthest = std::max(std::abs(t), std::abs(t_stop));
    if (!(furthest + fast_step_ / 2 > furthest)) return ARK_INNERSTEP_FAIL;
    return evolve_mri(slow_.get(), t_stop, y(), &t, ARK_ONE_STEP);
  }

  // e = (0, M^-1 f_soft).
  static int soft_rate(double t, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<Mri*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const bool is_finite = self.set_rate(self.soft_, t, y, rate);
      Halves(rate).q.setZero();
      return is_finite;
    });
  }
  static int stiff_rate(double t, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<Mri*>(static_cast<Library*>(user));
    return self.guarded([&] { return self.set_rate(self.stiff_, t, y, rate); });
  }

  OwnCounts own_counts() const override {
    OwnCounts own;
    check(get_mri_steps(slow_.get(), &own.steps), "get_mri_steps");
    return own;
  }

  Cause cause_of(int flag) const override { return cause_of_arkode(flag); }
  std::string flag_name(int flag) const override {
    const std::unique_ptr<char, decltype(&std::free)> text(ARKodeGetReturnFlagName(flag),
                                                           std::free);
    return fmt::format("ARKODE {}", text ? text.get() : "");
  }

  const System &stiff_, &soft_;
  double fast_steps_ = 1;  // in each step
  double fast_step_ = 0;   // [s]
  std::unique_ptr<void, FreeMemoryBy<ARKodeFree>> fast_;
  InnerStepper inner_;
  std::unique_ptr<void, FreeMemoryBy<free_mri>> slow_;
};

template <int order>
Method mri() {
  static_assert(pairs[order - 3].order == order);
  return {
      .name = fmt::format("arkode_mri{}", order),
      .summary = fmt::format("SUNDIALS ARKODE, explicit multirate of order {}, ARKODE_{}: stiff "
                             "springs at a small step inside",
                             order, pairs[order - 3].name),
      .source = "Sandu, SIAM J. Numerical Analysis 57:5 (2019) 2300-2327",
      .order = order,
      .family = Family::sundials,
      .needs = {Need::conservative, Need::stiffness, Need::split_forces},
      .why_not_damped = "its fast half has no place for dashpots",
      .make = create_steps<Mri<order>>};
}

}  // namespace

Method arkode_mri3() { return mri<3>(); }
Method arkode_mri4() { return mri<4>(); }

}  // namespace qddot::registered
