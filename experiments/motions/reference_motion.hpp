#pragma once

#include <optional>
#include <vector>

#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::motions {

using namespace measure;

// The motion that others are compared with, at some times.
struct ReferenceMotion {
  const Method* method = nullptr;  // the run that makes it, with its
  double value = 0;                // knob
  std::vector<State> states;       // at the times; the first is the start
  double error = 0;                // the position error at its end; not above what was asked for
};

// The states of a run at `times` [s], of which the first is 0 and the last the end; fewer where it
// does not come as far.
std::vector<State> states_at(const std::vector<double>& times, const ReducedScene& scene,
                             const Method& method, const Options& options, double seconds);

// The motion of the reference at `times`, by a run that is fast and far more accurate than most:
// the fastest of the points with an error of at most 1e-9, or ten times the least; or, where none
// is below 1e-6, by Kahan and Li's composition with smaller and smaller steps. Nothing where no run
// comes to 1e-6 of the reference in some `seconds`, as beyond the horizon of a chaotic motion.
std::optional<ReferenceMotion> reference_motion(const std::vector<double>& times,
                                                const ReducedScene& scene,
                                                const Reference& reference,
                                                const std::vector<Point>& points,
                                                const Options& options, double seconds);

}  // namespace qddot::motions
