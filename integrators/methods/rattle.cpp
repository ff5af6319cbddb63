// RATTLE: velocity Verlet that keeps the lengths of rods (base/rattle_steps.hpp), and symmetric
// compositions of it. A composition takes steps of the sizes gamma_i h with
//   sum gamma_i = 1,   sum gamma_i^3 = 0, ...
// Some gamma_i are negative. rattle4 has Suzuki's five, rattle6 Kahan and Li's nine, rattle8 the 17
// of kahan_li8. A step takes as many forces, and for each of them a factorisation of G M^-1 G' and
// some solves with it. Stability limits are those of vibrations without rods.
#include <cmath>

#include "integrators/methods/kahan_li8.hpp"
#include "qddot/integrators/base/rattle_steps.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

const Splitting& rattle_splitting() {
  static const Splitting splitting = verlet_composition(2, {1});
  return splitting;
}

const Splitting& rattle4_splitting() {
  static const Splitting splitting = [] {
    const double gamma = 1 / (4 - std::cbrt(4.0));
    return verlet_composition(4, {gamma, gamma, 1 - 4 * gamma, gamma, gamma});
  }();
  return splitting;
}

const Splitting& rattle6_splitting() {
  static const Splitting splitting =
      verlet_composition(6, mirrored({0.39216144400731413927925056, 0.33259913678935943859974864,
                                      -0.70624617255763935980996482, 0.08221359629355080023149045,
                                      0.79854399093482996339895035},
                                     9));
  return splitting;
}

Method composition(const char* name, const char* summary, const char* source,
                   const Splitting& splitting, double stability_limit) {
  const bool is_rattle = splitting.drifts.size() == 1;
  return {.name = name,
          .summary = summary,
          .source = source,
          .order = splitting.order,
          .stability_limit = stability_limit,
          .friction_lag = is_rattle ? 2.0 : 0.0,
          .traits = {Trait::symplectic, Trait::reversible},
          .needs = {Need::conservative, Need::constraints},
          .splitting = &splitting,
          .damped = is_rattle ? Damped::by_any : Damped::by_air,
          .why_not_damped = is_rattle ? "" : "it drifts back in time, where dashpots add energy",
          .make = create_rattle};
}

}  // namespace

Method rattle() {
  return composition("rattle", "Verlet with rods; one force a step",
                     "Andersen, J. Computational Physics 52 (1983) 24-34", rattle_splitting(), 2);
}

Method rattle4() {
  return composition("rattle4", "five RATTLE steps composed to order 4",
                     "Suzuki, Physics Letters A 146 (1990) 319-323; Reich, SIAM J. Numerical "
                     "Analysis 33 (1996) 475-491",
                     rattle4_splitting(), 2.7209745385601494);
}

Method rattle6() {
  return composition("rattle6", "nine RATTLE steps composed to order 6",
                     "Kahan and Li, Mathematics of Computation 66 (1997) 1089-1099, s9odr6a",
                     rattle6_splitting(), 2.5326273883342973);
}

Method rattle8() {
  return composition("rattle8", "17 RATTLE steps composed to order 8",
                     "Kahan and Li, Mathematics of Computation 66 (1997) 1089-1099, s17odr8a",
                     kahan_li8_splitting(), 3.0964386800007322);
}

}  // namespace qddot::registered
