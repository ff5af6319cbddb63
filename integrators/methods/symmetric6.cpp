// The symmetric multistep formula of six steps, order 6, one force a step, whose spurious roots are
// at the cosines 1/20 and -1/2:
//   r(z) = (z^2 - z/10 + 1)(z^2 + z + 1).
// With 0 for 1/20 the limit is 1.130, but the roots are nearer to each other, and the energy of an
// orbit goes to and fro by much more at h w = 0.6.
#include "qddot/integrators/base/symmetric_multistep.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const SymmetricFormula& symmetric6_formula() {
  static const SymmetricFormula formula{.steps = 6,
                                        .rho_denominator = 10,
                                        .rho = {10, -11, 11, -20},
                                        .beta_denominator = 2400,
                                        .beta = {3323, -392, 7818},
                                        .single_step = dprkn6_pair};
  return formula;
}

Method symmetric6() {
  return {.name = "symmetric6",
          .summary = "symmetric multistep of order 6, one force a step, at h < 1.1/w_max",
          .source =
              "derived in the file, after Quinlan and Tremaine, Astronomical Journal 100 (1990) "
              "1694-1700",
          .order = 6,
          .stability_limit = 1.1254974776976225,
          .recurrence_roots = symmetric_roots<symmetric6_formula>,
          .make = create_symmetric<symmetric6_formula>};
}

}  // namespace qddot::registered
