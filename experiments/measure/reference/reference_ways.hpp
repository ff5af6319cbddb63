#pragma once

#include <optional>
#include <string>
#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference.hpp"

namespace qddot::measure {

// The end of a motion computed in one way.
struct Solution {
  State end{};
  Scales scales{};
  double knob = 0;
  std::string made_by{};
  std::vector<State> path{};  // on the way, at some of the samples, the end included
  Errors change{};            // how much refining it may still move the end; zero if not refined
};

// The motion from `initial` by a method with these options. Its scales are those seen at the ends
// of `samples` equal parts of the time, or of some of them where they are more than a million;
// about a hundred of these are its path. Nothing where it does not reach the end in so many
// seconds.
std::optional<Solution> seen_run(const ReducedScene& scene, const Method& method,
                                 const Options& options, const State& initial, double until,
                                 std::int64_t samples, double seconds);

// By Kahan and Li's composition of order 8 with steps of h [s], its scales seen at each.
std::optional<Solution> composition(const ReducedScene& scene, const State& initial, double until,
                                    double h, double seconds);

// Fehlberg 7(8) in the variables (q - q0) / displacement and v / speed, all of order one; each part
// of the scene with scales and steps of its own.
std::optional<Solution> fehlberg(const ReducedScene& scene, double until, double tolerance,
                                 const Scales& scales, double seconds);

// The reference whose end is that of `one`, certified by `other`.
//
// What is certified is twice the largest of: how far the two differ, the last change of each under
// refinement, and `rounding_effect`, what a rounding of the start does to the end. Where truncation
// is left, each change is larger than the error that follows it, and the difference sees the error
// of both. Where only rounding is left, these are distances of the one end from others that err as
// much by chance: its error is above twice all of them only if the others err by nearly as much to
// the same side, all of them within half of its own. What both have in common, the rounding of the
// scene's own numbers, is what that stands for.
Reference joined(const ReducedScene& scene, const Solution& one, const Solution& other,
                 const Errors& rounding_effect = {});

}  // namespace qddot::measure
