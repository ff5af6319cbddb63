// Kahan and Li's composition of order 8, their s17odr8a: 17 steps of velocity Verlet of the sizes
// gamma_s h.
//   for s = 1 ... 17:   v <- v + gamma_s h/2 M^-1 f(q)
//                       q <- q + gamma_s h v
//                       v <- v + gamma_s h/2 M^-1 f(q)
// The gamma_s have the sum 1 and are the same read backwards, so the method is time-reversible. It
// is symplectic as well. Neighbouring half kicks are one kick, and the last force of a step is the
// first of the next: 17 forces a step, and one to begin.
#include "integrators/methods/kahan_li8.hpp"

#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
const Splitting& kahan_li8_splitting() {
  static const Splitting splitting =
      verlet_composition(8, mirrored({0.13020248308889008087881763, 0.56116298177510838456196441,
                                      -0.38947496264484728640807860, 0.15884190655515560089621075,
                                      -0.39590389413323757733623154, 0.18453964097831570709183254,
                                      0.25837438768632204729397911, 0.29501172360931029887096624,
                                      -0.60550853383003451169892108},
                                     17));
  return splitting;
}

Method kahan_li8() {
  return {.name = "kahan_li8",
          .summary = "17 Verlet steps composed to order 8; for the accurate end of the chart",
          .source = "Kahan and Li, Mathematics of Computation 66 (1997) 1089-1099",
          .order = 8,
          .stability_limit = 3.0964386800007322,  // where the trace of one step first exceeds 2
          .traits = {Trait::symplectic, Trait::reversible},
          .needs = {Need::conservative},
          .takes = {Option::compensated},
          .splitting = &kahan_li8_splitting(),
          .damped = Damped::by_air,
          .why_not_damped = "it drifts back in time, where dashpots add energy",
          .make = create_splitting};
}

}  // namespace qddot::registered
