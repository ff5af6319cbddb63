// The symmetric multistep formula of four steps, order 4, one force a step, whose spurious roots
// are at the cosine 1/4:
//   r(z) = z^2 - z/2 + 1.
// The limit of h w grows with the cosine, and the phase error with it: the limit is 1.73 at the
// cosine 0 (Lambert and Watson's formula) and 1.83 here. Beyond, the roots come near the motion's
// own.
#include "qddot/integrators/base/symmetric_multistep.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const SymmetricFormula& symmetric4_formula() {
  static const SymmetricFormula formula{.steps = 4,
                                        .rho_denominator = 2,
                                        .rho = {2, -5, 6},
                                        .beta_denominator = 8,
                                        .beta = {9, -6},
                                        .single_step = dprkn6_pair};
  return formula;
}

Method symmetric4() {
  return {
      .name = "symmetric4",
      .summary =
          "symmetric multistep of order 4, one force a step; as cheap as Verlet, at h < 1.8/w_max",
      .source =
          "derived in the file, after Quinlan and Tremaine, Astronomical Journal 100 (1990) "
          "1694-1700",
      .order = 4,
      .stability_limit = 1.8257418583505537,
      .recurrence_roots = symmetric_roots<symmetric4_formula>,
      .make = create_symmetric<symmetric4_formula>};
}

}  // namespace qddot::registered
