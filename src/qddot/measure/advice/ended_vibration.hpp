#pragma once

#include <optional>

#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/advice/trial.hpp"

namespace qddot::inline measure {

// Stiff springs that start with a stretch, or change their length, vibrate, and damping ends that.
// The forces of a vibration and of its damping act along the springs. So they move the slow motion
// by M^-1 G' times some impulses, and what remains at the end is the start laid onto the rods along
// M^-1 G', places and velocities alike (Multipliers::project).

// The scene with its start laid onto its rods so; nothing if that fails. Pins stay.
std::optional<Scene> laid_on_rods(const Scene& scene, const Reductions& reductions);

// How far the answer of rods that began laid so is from the motion of springs, relative to the
// motion at its end.
struct VibrationCheck {
  const Model& springs;   // the motion as it starts, with springs
  const Model& rods;      // of the answer
  const Answer& answer;   // by a method of rods
  const Stage& scales;    // of that motion
  double until;           // [s]
  double first, longest;  // times up to which springs may run [s]; the first is doubled
  double tolerance;       // below which the change need not be known better
};

// The springs run to a time, and their state is laid onto the rods, which run from there to the
// end. The distance of both ends, and that by which the state was moved at that time, bound what
// the vibration before changes and what is left of it. Twice the larger of two times of which one
// is double, once both are within `tolerance`; nothing if that is not seen. No run begins after
// `seconds`.
std::optional<double> change_by_vibration(const VibrationCheck& check, double seconds);

}  // namespace qddot::inline measure
