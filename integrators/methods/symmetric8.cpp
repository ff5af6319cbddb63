// The symmetric multistep formula of eight steps and order 8. With a = M^-1 f(q) and the
// coefficients rho and beta of this file, which are the same read backwards, it is
//   sum_{j=0}^8 rho_j q_{n+j} = h^2 sum_{j=1}^7 beta_j a_{n+j}
// It takes one force a step. The first seven steps are computed together, by more forces. The
// polynomial of the left side is (z - 1)^2 r(z) with
//   r(z) = (z^2 - z + 1)(z^2 + 1)(z^2 + z + 1)
// The roots of r are spurious: they belong to the formula, not to the motion. They lie on the unit
// circle, at angles of the cosines 1/2, 0 and -1/2. So no vibration grows or dies up to a limit of
// h w.
#include "integrators/methods/tables.hpp"
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
          .traits = {Trait::remembers_steps},
          .needs = {Need::conservative},
          .symmetric_formula = &symmetric8_formula(),
          .why_not_damped = "a spurious root of its formula grows with any dashpot",
          .make = create_symmetric};
}

}  // namespace qddot::registered
