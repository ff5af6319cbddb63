// The symmetric multistep formula of four steps and order 4. With a = M^-1 f(q) it is
//   q_{n+4} - 5/2 q_{n+3} + 3 q_{n+2} - 5/2 q_{n+1} + q_n
//     = h^2/8 (9 a_{n+3} - 6 a_{n+2} + 9 a_{n+1})
// It takes one force a step. The first three steps are computed together, by more forces. The
// polynomial of the left side is (z - 1)^2 r(z) with
//   r(z) = z^2 - z/2 + 1
// The roots of r are spurious: they belong to the formula, not to the motion. They lie on the unit
// circle, at an angle of cosine 1/4. So no vibration grows or dies up to a limit of h w. The limit
// grows with the cosine, and so does the phase error. It is 1.73 at the cosine 0 (the formula of
// Lambert and Watson) and 1.83 here. Larger cosines bring the roots near those of the motion.
#include "integrators/methods/tables.hpp"
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
      .traits = {Trait::remembers_steps},
      .needs = {Need::conservative},
      .symmetric_formula = &symmetric4_formula(),
      .make = create_symmetric};
}

}  // namespace qddot::registered
