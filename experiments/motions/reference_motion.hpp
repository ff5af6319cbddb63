#pragma once

#include <optional>
#include <vector>

#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::motions {

// The motion that others are compared with, at some times.
struct ReferenceMotion {
  const Method* method = nullptr;  // the run that makes it, with its
  double value = 0;                // knob
  std::vector<State> states;       // at the times; the first is the start
  double error = 0;                // its position error at the end: nearer distances mean nothing
};

// The states of a run at `times` [s], from 0 to the end; fewer if it does not reach the end.
std::vector<State> states_at(const std::vector<double>& times, const Model& scene,
                             const Method& method, const Options& options, double seconds);

// The motion of the reference at `times` [s]. It is Kahan and Li's composition with smaller and
// smaller steps. These end when its distance to the reference's end is the certified error, only
// rounding is left, or `seconds` are over. It is the run of the most accurate point if that is
// nearer. Empty if neither comes within 1e-6 of the end, as beyond the horizon of a chaotic motion.
std::optional<ReferenceMotion> reference_motion(const std::vector<double>& times,
                                                const Model& scene, const Reference& reference,
                                                const std::vector<Point>& points,
                                                const Options& options, double seconds);

}  // namespace qddot::motions
