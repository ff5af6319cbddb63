// The symmetric multistep formula of eight steps, order 8, one force a step, whose spurious roots
// are at the cosines 1/2, 0 and -1/2:
//   r(z) = (z^2 - z + 1)(z^2 + 1)(z^2 + z + 1).
#include "qddot/integrators/base/symmetric_multistep.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const SymmetricFormula& symmetric8_formula() {
  static const SymmetricFormula formula{.steps = 8,
                                        .rho_denominator = 1,
                                        .rho = {1, -2, 3, -4, 4},
                                        .beta_denominator = 10080,
                                        .beta = {14689, -18666, 58383, -48332},
                                        .single_step = dprkn8_pair};
  return formula;
}

Method symmetric8() {
  return {.name = "symmetric8",
          .summary = "symmetric multistep of order 8, one force a step, at h < 0.96/w_max",
          .source =
              "derived in the file, after Quinlan and Tremaine, Astronomical Journal 100 (1990) "
              "1694-1700",
          .order = 8,
          .stability_limit = 0.9601524432891618,
          .recurrence_roots = symmetric_roots<symmetric8_formula>,
          .make = create_symmetric<symmetric8_formula>};
}

}  // namespace qddot::registered
