#pragma once

#include <string>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// Half a sentence on a step size that is unstable from the start: it is above the method's linear
// limit, or the method grows at every h. Empty for stable step sizes, for methods that choose their
// steps, and for methods whose steps are for the soft springs alone.
std::string step_warning(const Method& method, const Options& options, const Model& scene);

// A sentence if a run's energy has grown to more than ten times what its motion can have, for any
// outcome and method; else empty. A symplectic method just below its limit may come near that: at h
// w = 1.9 energies swing by 1/(1 - (h w)^2/4) = 10.
std::string growth_warning(const Method& method, const Summary& summary);

// Explains, in a few sentences, why a run of fixed steps failed with `summary`, and names step
// sizes and methods that do not fail. It says
// - the step in which the run failed,
// - the limit that it crossed: h w_max over the motion while its energy was about the same, or h
//   times the rate at which compressed springs push sideways,
// - the largest of h/2, h/4, ... and the methods at this h that reach the end, found by trying them
//   for about `seconds` at most.
// If the forces of the start are extreme, it says only that, for any method. Empty for other
// methods and outcomes.
std::string diagnosis(const Method& method, const Options& options, const Model& scene,
                      double until, const Summary& summary, double seconds);

}  // namespace qddot::inline measure
