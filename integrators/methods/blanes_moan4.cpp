// Blanes and Moan's symplectic Runge-Kutta-Nystrom splitting of order 4, SRKN_6^b. A step takes
// seven kicks and six drifts by turns:
//   for i = 1 ... 7:   v <- v + b_i h M^-1 f(q),   q <- q + a_i h v,   a_7 = 0
// Order 4 needs fewer of them; the others make the error small. Both lists of coefficients are the
// same read backwards, so the method is time-reversible. The last force of a step is the first of
// the next: six forces a step, and one to begin.
#include "qddot/integrators/base/kick_drift.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// The paper prints 15 digits. These are the nearest numbers, less than 2e-16 away, that meet the
// conditions of order 4 to 40 digits.
const Splitting& blanes_moan4_splitting() {
  static const Splitting splitting{
      .order = 4,
      .kicks = mirrored({0.08298440641740501883835, 0.3963098014983680770949,
                         -0.03905630492234843517087, 0.1195241940131506784752},
                        7),
      .drifts = mirrored(
          {0.2452989571842711626039, 0.6048726657110799749609, -0.3501716228953511375648}, 6)};
  return splitting;
}

}  // namespace

Method blanes_moan4() {
  return {.name = "blanes_moan4",
          .summary = "symplectic splitting of order 4 with six forces a step and a small error",
          .source =
              "Blanes and Moan, J. Computational and Applied Mathematics 142 (2002) 313-330, "
              "table 3, SRKN_6^b",
          .order = 4,
          .stability_limit = 3.1634650665581848,  // where the trace of one step first exceeds 2
          .traits = {Trait::symplectic, Trait::reversible},
          .needs = {Need::conservative},
          .takes = {Option::compensated},
          .splitting = &blanes_moan4_splitting(),
          .damped = Damped::by_air,
          .why_not_damped = "it drifts back in time, where dashpots add energy",
          .make = create_splitting};
}

}  // namespace qddot::registered
