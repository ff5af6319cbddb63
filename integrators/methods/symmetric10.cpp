// The symmetric multistep formula of ten steps, order 10, one force a step, whose spurious roots
// are at the cosines 3/5, 2/5, -1/4 and -1/2.
#include "qddot/integrators/base/symmetric_multistep.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const SymmetricFormula& symmetric10_formula() {
  static const SymmetricFormula formula{.steps = 10,
                                        .rho_denominator = 50,
                                        .rho = {50, -125, 223, -324, 399, -446},
                                        .beta_denominator = 42000,
                                        .beta = {65257, -142340, 435940, -629852, 844390},
                                        .single_step = dprkn12_pair};
  return formula;
}

Method symmetric10() {
  return {.name = "symmetric10",
          .summary = "symmetric multistep of order 10, one force a step, at h < 0.8/w_max",
          .source =
              "derived in the file, after Quinlan and Tremaine, Astronomical Journal 100 (1990) "
              "1694-1700",
          .order = 10,
          .stability_limit = 0.7997861586100952,
          .recurrence_roots = symmetric_roots<symmetric10_formula>,
          .make = create_symmetric<symmetric10_formula>};
}

}  // namespace qddot::registered
