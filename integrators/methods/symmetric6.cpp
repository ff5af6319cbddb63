// The symmetric multistep formula of six steps and order 6. With a = M^-1 f(q) it is
//   q_{n+6} - 11/10 q_{n+5} + 11/10 q_{n+4} - 2 q_{n+3} + 11/10 q_{n+2} - 11/10 q_{n+1} + q_n
//     = h^2/2400 (3323 a_{n+5} - 392 a_{n+4} + 7818 a_{n+3} - 392 a_{n+2} + 3323 a_{n+1})
// It takes one force a step. The first five steps are computed together, by more forces. The
// polynomial of the left side is (z - 1)^2 r(z) with
//   r(z) = (z^2 - z/10 + 1)(z^2 + z + 1)
// The roots of r are spurious: they belong to the formula, not to the motion. They lie on the unit
// circle, at angles of the cosines 1/20 and -1/2. So no vibration grows or dies up to a limit of
// h w. The cosine 0 in place of 1/20 makes the limit 1.130, but brings the roots nearer to each
// other. The energy of an orbit then goes to and fro by much more at h w = 0.6.
#include "integrators/methods/tables.hpp"
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
          .traits = {Trait::remembers_steps},
          .needs = {Need::conservative},
          .symmetric_formula = &symmetric6_formula(),
          .why_not_damped = "a spurious root of its formula grows with any dashpot",
          .make = create_symmetric};
}

}  // namespace qddot::registered
