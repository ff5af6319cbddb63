// ARKODE's adaptive explicit Runge-Kutta methods with relaxation: each step keeps the energy. With
// y = (q, v), F(y) = (v, M^-1 f(q)), the coefficients a_ij and b_i of the named table, and the
// energy E(y) = v'M v/2 + V(q):
//   Y_i     = y_n + h sum_{j<i} a_ij F(Y_j),   d = h sum_{i<=s} b_i F(Y_i)
//   y_{n+1} = y_n + r d,   t_{n+1} = t_n + r h,   where E(y_n + r d) = E(y_n),   r near 1
// E is constant along the motion, so r solves one equation. ARKODE does that by Newton's method,
// with E and its gradient (-f, M v), which takes another force at each stage. The order is that of
// the table, since r = 1 + O(h^(p-1)) is also in the time. ARKODE relaxes tables whose b_i are not
// negative only. Steps are held to what the largest frequency allows, as those of arkode_erk.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "integrators/sundials/explicit_tables.hpp"
#include "integrators/sundials/imaginary_stability.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

constexpr ExplicitTable relaxed_tables[] = {
    {4, ARKODE_ZONNEVELD_5_3_4, "ARKODE_ZONNEVELD_5_3_4", "the table is Zonneveld's (1963)"},
    {5, ARKODE_CASH_KARP_6_4_5, "ARKODE_CASH_KARP_6_4_5",
     "the table is Cash and Karp's, ACM TOMS 16:3 (1990) 201-222"},
    {6, ARKODE_VERNER_8_5_6, "ARKODE_VERNER_8_5_6",
     "the table is Verner's, SIAM J. Numerical Analysis 15:4 (1978) 772-790"}};

#if QDDOT_SUNDIALS >= 70100

// A change of E below this part of its size is rounding, about 1e-16 for each of some hundred
// terms. The first steps are often so short that there is no other.
constexpr double rounding = 1e-13;

template <int which>
class Relaxed final : public Arkode {
 public:
  explicit Relaxed(SystemRun& run) : Relaxed(run, table_of(relaxed_tables[which])) {}

 private:
  Relaxed(SystemRun& run, ButcherTable table)
      : Arkode(run, {.explicit_table = table.get()}, right_hand_side, nullptr, nullptr,
               run.system()) {
    limit_steps(system(), imaginary_stability(*table));
    check(ARKodeSetRelaxFn(memory(), energy, gradient), "ARKodeSetRelaxFn");
    check(ARKodeSetRelaxResTol(memory(), rounding), "ARKodeSetRelaxResTol");
  }

  void start(const State& state) override {
    Arkode::start(state);
    const double potential = system().potential({state.t, state.q, state.v});
    const double speed = options().speed;
    const double kinetic = kinetic_energy(state.v) + system().mass().sum() * speed * speed / 2;
    per_size_ = 1 / std::max(std::abs(potential) + kinetic, std::numeric_limits<double>::min());
  }

  double kinetic_energy(const ConstVec& v) const {
    return v.cwiseProduct(system().mass()).dot(v) / 2;
  }

  // E as a part of its size at the start, since ARKODE compares its changes with an absolute bound.
  static int energy(N_Vector y, double* e, void* user) {
    auto& self = *static_cast<Relaxed*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const Halves at(y);
      *e = self.per_size_ * (self.kinetic_energy(at.v) + self.system().potential({0, at.q, at.v}));
      return std::isfinite(*e);
    });
  }
  static int gradient(N_Vector y, N_Vector slope, void* user) {
    auto& self = *static_cast<Relaxed*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const Halves at(y);
      Halves change(slope);
      change.q = -self.per_size_ * self.force_at(self.system(), 0, at);
      change.v = self.per_size_ * self.system().mass().cwiseProduct(at.v);
      return std::isfinite(change.q.sum());
    });
  }

  double per_size_ = 1;  // [1/J]
};
template <int which>
constexpr MakeStepper make_relaxed = create_steps<Relaxed<which>>;

#else

template <int>
constexpr MakeStepper make_relaxed = nullptr;

#endif

template <int which>
Method relaxed() {
  const ExplicitTable& table = relaxed_tables[which];
  return {.name = fmt::format("arkode_relaxed{}", table.order),
          .summary = fmt::format("SUNDIALS ARKODE, adaptive explicit of order {} that keeps the "
                                 "energy, {}, steps held to 1/w_max",
                                 table.order, table.name),
          .source = fmt::format("Ketcheson, SIAM J. Numerical Analysis 57:6 (2019) 2850-2870; {}",
                                table.source),
          .order = table.order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::bounds_steps},
          .needs = {Need::conservative, Need::autonomous},
          .needs_sundials = 70100,
          .make = make_relaxed<which>};
}

}  // namespace

Method arkode_relaxed4() { return relaxed<0>(); }
Method arkode_relaxed5() { return relaxed<1>(); }
Method arkode_relaxed6() { return relaxed<2>(); }

}  // namespace qddot::registered
