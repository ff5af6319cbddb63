#pragma once

#include <optional>

#include "qddot/measure/motion/error.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// Stiff springs that start with a stretch, or change their length, vibrate, and damping ends that.
// The forces of a vibration and of its damping act along the springs. So they move the slow motion
// by M^-1 G' times some impulses, and what remains at the end is the start laid onto the rods along
// M^-1 G', places and velocities alike (Multipliers::project).

// The scene with its start laid onto its rods so; nothing if that fails. Pins stay.
std::optional<Scene> laid_on_rods(const Scene& scene, const Reductions& reductions);

// How far the motion of rods that begin laid so is from that of springs, relative to the motion at
// its end.
struct VibrationCheck {
  const Model& springs;   // as the motion starts
  const Model& rods;      // laid so
  const Scales& scales;   // of the motion of rods
  double until;           // [s]
  double first, longest;  // times up to which springs may run [s]; the first is doubled
  double tolerance;       // [relative], of the change
};

// The springs run to a time, and their state is laid onto the rods, which run from there to the
// end. What the vibration changes until then is the distance from the end of rods that began at
// once; what is left of it is how far the state was moved. Between two times, of which one is
// double, the effect has to fall by half, or it counts as if it went on at its rate. All this
// together bounds the change, once it is within the tolerance; nothing if that is not seen. No run
// begins after `seconds`.
std::optional<double> change_by_vibration(const VibrationCheck& check, double seconds);

}  // namespace qddot::inline measure
