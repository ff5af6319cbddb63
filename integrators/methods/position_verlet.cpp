// Position Verlet (Stormer-Verlet as drift, kick, drift):
//   q_{n+1/2} = q_n + h/2 v_n
//   v_{n+1}   = v_n + h M^-1 f(q_{n+1/2})
//   q_{n+1}   = q_{n+1/2} + h/2 v_{n+1}
// The method has order 2, is symplectic and time-reversible, and takes one force a step. A
// vibration q'' = -w^2 q stays bounded for h w < 2 and grows above.
#include "qddot/integrators/base/kick_drift.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

const Splitting& position_verlet_splitting() {
  static const Splitting splitting{.order = 2, .kicks = {1}, .drifts = {1. / 2, 1. / 2}};
  return splitting;
}

}  // namespace

Method position_verlet() {
  return {.name = "position_verlet",
          .summary = "Verlet with its one force a step in the middle, between two half drifts",
          .source =
              "Tuckerman, Berne and Martyna, J. Chemical Physics 97 (1992) 1990-2001, "
              "position Verlet",
          .order = 2,
          .stability_limit = 2,
          .traits = {Trait::symplectic, Trait::reversible},
          .needs = {Need::conservative},
          .takes = {Option::compensated},
          .splitting = &position_verlet_splitting(),
          .damped = Damped::by_air,
          .why_not_damped =
              "its kick comes before the velocity that dashpots need, which leaves order 1",
          .make = create_splitting};
}

}  // namespace qddot::registered
