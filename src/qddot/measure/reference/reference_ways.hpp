#pragma once

#include <optional>
#include <string>
#include <vector>

#include "qddot/integrators/integrator.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference.hpp"

namespace qddot::inline measure {

// The end of a motion computed by one method.
struct Solution {
  State end{};
  Scales scales{};
  double knob = 0;
  std::string made_by{};
  std::vector<Break> breaks{};
  std::vector<State> path{};  // at some of the looks, the end included
  Errors change = no_error;   // change that refinement may still make; zero if not refined
};

// The motion from `initial` by a method with these options, to the last of `times` [s]. Its scales
// are taken at all of them. Up to a hundred make its path, drawn at random so that they are not in
// step with the motion; the end is one. Empty if it does not reach the end in `seconds`.
std::optional<Solution> seen_run(const Model& scene, const Method& method, const Options& options,
                                 const State& initial, const std::vector<double>& times,
                                 double seconds);

// The method of order 8 and constant steps that resolves vibrations: Kahan and Li's composition or,
// if dashpots forbid its steps back in time, Prince and Dormand's.
const Method& resolving_method(const System& system);

// The motion by that method with steps of h [s], with scales from each step; of more than a
// million, from random ones.
std::optional<Solution> composition(const Model& scene, const State& initial, double until,
                                    double h, double seconds);

// The motion by Fehlberg 7(8), or by ARKODE's pair of order 8 where springs go slack or break; in
// the variables (q - q0) / displacement and v / speed, which are of
// order one. Each part of the scene has its own scales and steps.
std::optional<Solution> fehlberg(const Model& scene, double until, double tolerance,
                                 const Scales& scales, double seconds);

// The reference whose end is that of `one`, certified by `other`.
//
// The certified error is twice the largest of three: the difference of the two, the last change of
// each under refinement, and `rounding_effect` (of a rounding of the start on the end). If
// truncation errors are left, each change is larger than the error after it, and the difference
// contains the errors of both. If only rounding errors are left, all three are distances between
// ends with independent errors of one size. The error of `one` exceeds twice each of them only if
// all the others have nearly the same error: in its direction, within half of its size. The
// rounding of the scene's own numbers is common to both; `rounding_effect` stands for it.
Reference joined(const Model& scene, const Solution& one, const Solution& other,
                 const Errors& rounding_effect = no_error);

}  // namespace qddot::inline measure
