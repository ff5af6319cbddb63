// The symmetric multistep formula of six steps, order 6, one force a step, whose spurious roots are
// at the cosines 0 and -1/2:
//   r(z) = (z^2 + 1)(z^2 + z + 1).
#include "qddot/integrators/base/symmetric_multistep.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const SymmetricFormula& symmetric6_formula() {
  static const SymmetricFormula formula{.steps = 6,
                                        .rho_denominator = 1,
                                        .rho = {1, -1, 1, -2},
                                        .beta_denominator = 120,
                                        .beta = {167, -8, 402},
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
          .stability_limit = 1.1298653657320641,
          .recurrence_roots = symmetric_roots<symmetric6_formula>,
          .make = create_symmetric<symmetric6_formula>};
}

}  // namespace qddot::registered
