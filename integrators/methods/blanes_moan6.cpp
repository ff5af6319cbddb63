// Blanes and Moan's symplectic Runge-Kutta-Nystrom splitting of order 6, SRKN_11^b. A step takes
// twelve kicks and eleven drifts by turns:
//   for i = 1 ... 12:   v <- v + b_i h M^-1 f(q),   q <- q + a_i h v,   a_12 = 0
// Order 6 needs fewer of them; the others make the error small. Both lists of coefficients are the
// same read backwards, so the method is time-reversible. The last force of a step is the first of
// the next: eleven forces a step, and one to begin.
#include "qddot/integrators/base/kick_drift.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// The paper prints 15 digits. These are the nearest numbers, less than 7e-16 away, that meet the
// conditions of order 6 to 40 digits.
const Splitting& blanes_moan6_splitting() {
  static const Splitting splitting{
      .order = 6,
      .kicks = mirrored(
          {0.04146499851826284329878, 0.1981286719180665411367, -0.04000619210415268688883,
           0.07525398430158034112788, -0.01151138742068777006244, 0.2366699247869307313879},
          12),
      .drifts =
          mirrored({0.1232297759462711515611, 0.2905537977995582703664, -0.1270492126254169156625,
                    -0.246331761062075404195, 0.3572088727959277526199, 0.2047770542914702906202},
                   11)};
  return splitting;
}

}  // namespace

Method blanes_moan6() {
  return {.name = "blanes_moan6",
          .summary = "symplectic splitting of order 6 with eleven forces a step and a small error",
          .source =
              "Blanes and Moan, J. Computational and Applied Mathematics 142 (2002) 313-330, "
              "table 3, SRKN_11^b",
          .order = 6,
          .stability_limit = 3.1414310877528075,  // where the trace of one step first exceeds 2
          .traits = {Trait::symplectic, Trait::reversible},
          .needs = {Need::conservative},
          .takes = {Option::compensated},
          .splitting = &blanes_moan6_splitting(),
          .damped = Damped::by_air,
          .why_not_damped = "it drifts back in time, where dashpots add energy",
          .make = create_splitting};
}

}  // namespace qddot::registered
