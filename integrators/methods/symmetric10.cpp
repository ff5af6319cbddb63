// The symmetric multistep formula of ten steps, order 10, one force a step, whose spurious roots
// are at the cosines 13/20, 2/5, -1/5 and -1/2: formulas of other cosines have a limit as large,
// but roots that come nearer to each other.
#include "qddot/integrators/base/symmetric_multistep.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const SymmetricFormula& symmetric10_formula() {
  static const SymmetricFormula formula{.steps = 10,
                                        .rho_denominator = 250,
                                        .rho = {250, -675, 1225, -1796, 2221, -2450},
                                        .beta_denominator = 700000,
                                        .beta = {1078657, -2502716, 7298116, -10822532, 14130550},
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
          .stability_limit = 0.80073844315885567,
          .recurrence_roots = symmetric_roots<symmetric10_formula>,
          .make = create_symmetric<symmetric10_formula>};
}

}  // namespace qddot::registered
