#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "qddot/scene/model.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

// The properties of a scene and of the system that is left of it; no motion is computed.
struct Explanation {
  Index drawn_unknowns = 0;  // dimension x nodes
  Index unknowns = 0;
  std::vector<Finding> findings;
  bool stiffness_is_constant = false;
  std::size_t stiff_springs = 0;  // of the springs as drawn, if the scene names stiff ones
  // These are for the start of the system that is left:
  double omega_bound = 0;  // upper bound of w_max [rad/s], by Gershgorin; infinite without mass
  double omega_max = 0;    // by Lanczos, to about 1e-4; NaN if it was not found
  bool is_damped = false;
  // Damping ratios x'Cx/(2 w) of the lowest mode x that vibrates and of the highest; NaN if they
  // were not found. Above 1 a mode creeps.
  double zeta_lowest = NAN, zeta_highest = NAN;
  double verlet_step = 0;  // the largest stable step of verlet with this damping [s]; 0 if unknown
  // These are for the start, in all directions in which the nodes may move:
  int unstable = 0;           // directions in which V falls: K is indefinite if there are any
  int flat = 0;               // directions in which V is flat within rounding (see CurvatureSigns),
  double flat_rate = 0;       // and the rate [1/s] that bounds growth in them
  int unstable_left_out = 0;  // unstable ones that the reduced motion never enters
  double growth = 0;          // rate of the fastest one [1/s]; 0 if not known
  std::size_t fastest = 0;    // the node that moves most in the fastest one
  bool is_examined = true;    // false: the scene is too large, or K overflows
};

// The largest scenes, in unknowns as drawn, in which directions are examined, w_max is computed and
// damping ratios are; in larger ones they stay unknown. The default values take some seconds.
struct ExplanationLimits {
  Index examined = 100'000, frequency = std::numeric_limits<Index>::max(), damping = examined;
};
// Limits for a tenth of a second: for sidecars, which are written beside every run.
inline constexpr ExplanationLimits at_a_glance{6000, 6000, 0};

// Explains `scene` as it starts, and `model`. Throws nothing for any content of a scene, because
// each sidecar needs it.
Explanation explain(const Scene& scene, const Model& model, const ExplanationLimits& limits = {});

// The explanation in some lines, each ended by a line feed.
std::string explanation_in_words(const Explanation& explanation, const Scene& scene);

}  // namespace qddot
