#pragma once

#include "qddot/measure/motion/momenta.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// The scales for errors of invariants on a scene, the same for every method.
struct MotionScales {
  double energy = 0;  // E(0) [J]
  // Largest kinetic energy, or what driving has let pass through [J]; if nothing moves |E(0)|, else
  // 1 J.
  double kinetic = 1;
  double excess = 1;     // E(0) - V at the equilibrium downhill from the start, over `kinetic`; 1
                         // where there is none
  double frequency = 0;  // sqrt(<q'' M q''> / <q' M q'>) [rad/s]: the kinetic energy's frequency
  double rounding = 0;   // 2^-52 of the largest T + |V|, over `kinetic`
  double linear = 1, angular = 1;  // the nodes' largest momenta, see Momenta
};

// The largest finite natural frequency [rad/s] at the start of the motion.
double fastest_frequency(const Model& scene);

// Measures the scales in a run of 20 000 steps at h w_max = 1/2, or to `until` [s] if that is
// earlier. The method is Blanes and Moan's of order 4, or IDA if nodes are massless. A system
// without K has no known w_max: it is run to `until` by an adaptive method, and its excess is not
// looked for.
MotionScales motion_scales(const Model& scene, const Momenta& momenta, double until);

}  // namespace qddot::inline measure
