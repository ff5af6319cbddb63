// The symmetric multistep formula of ten steps and order 10. With a = M^-1 f(q) and the
// coefficients rho and beta of this file, which are the same read backwards, it is
//   sum_{j=0}^10 rho_j q_{n+j} = h^2 sum_{j=1}^9 beta_j a_{n+j}
// It takes one force a step. The first nine steps are computed together, by more forces. The
// polynomial of the left side is (z - 1)^2 r(z). The roots of r are spurious: they belong to the
// formula, not to the motion. They lie on the unit circle, at angles of the cosines 13/20, 2/5,
// -1/5 and -1/2. So no vibration grows or dies up to a limit of h w. Other cosines give limits as
// large, but roots that come nearer to each other.
#include "integrators/methods/tables.hpp"
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
          .traits = {Trait::remembers_steps},
          .needs = {Need::conservative},
          .symmetric_formula = &symmetric10_formula(),
          .why_not_damped = "a spurious root of its formula grows with any dashpot",
          .make = create_symmetric};
}

}  // namespace qddot::registered
