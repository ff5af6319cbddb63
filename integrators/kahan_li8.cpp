// Order-8 composition of 17 velocity Verlet steps of sizes gamma_s h, gamma symmetric, with
// sum gamma = 1 (Kahan and Li, Mathematics of Computation 66 (1997) 1089-1099, method s17odr8a).
// Neighbouring half kicks are one kick, and the last force of a step is the first of the next:
// 17 evaluations a step, and one to begin. Symplectic and time-reversible.
#include <array>

#include "integrators/fixed_step.hpp"
#include "integrators/registry.hpp"

namespace qddot {
namespace {

constexpr std::array<double, 17> gamma = [] {
  constexpr std::array<double, 9> half = {
      0.13020248308889008087881763, 0.56116298177510838456196441,  -0.38947496264484728640807860,
      0.15884190655515560089621075, -0.39590389413323757733623154, 0.18453964097831570709183254,
      0.25837438768632204729397911, 0.29501172360931029887096624,  -0.60550853383003451169892108};
  std::array<double, 17> all{};
  for (std::size_t s = 0; s < half.size(); ++s) all[s] = all[16 - s] = half[s];
  return all;
}();

class KahanLi8 final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  void start(const State& state) override { force(state.q, f_); }

  Outcome step(const State& now, double h, State& next) override {
    next.q = now.q;
    next.v = now.v;
    double before = 0;
    for (const double g : gamma) {
      next.v += ((before + g) * h / 2) * f_.cwiseQuotient(system().mass());
      next.q += g * h * next.v;
      force(next.q, f_);
      before = g;
    }
    next.v += (before * h / 2) * f_.cwiseQuotient(system().mass());
    return Outcome::reached_end;
  }

  Vec f_{system().size()};  // at the present state
};

}  // namespace

Method kahan_li8() {
  return {.name = "kahan_li8",
          .summary = "17 Verlet steps composed to order 8; for the accurate end of the chart",
          .source = "Kahan and Li, Mathematics of Computation 66 (1997) 1089-1099",
          .order = 8,
          .stability_limit = 3.1,  // where the trace of one step's matrix first exceeds 2
          .symplectic = true,
          .make = create<KahanLi8>};
}

}  // namespace qddot
