#pragma once

#include <string>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::measure {

// What is wrong from the start with steps of that size, in half a sentence: above the linear limit
// of an explicit method, or any at all where it grows at every h. Empty where nothing is, or for
// methods that choose their steps, or whose steps are for the soft springs alone.
std::string step_warning(const Method& method, const Options& options, const ReducedScene& scene);

// Whether a run's energy has grown to more than ten times what its motion can have, whatever the
// outcome and the method, in a sentence; empty where it has not. A symplectic method that just
// holds may come near that: at h w = 1.9 energies swing by 1/(1 - (h w)^2/4) = 10.
std::string growth_warning(const Method& method, const Summary& summary);

// Says of any method that the forces of the start are beyond all measure. Says why a run of fixed
// steps that failed with `summary` did so, and what would have held, in a few sentences: at which
// step; the limit that it crossed (h w_max over the motion so long as its energy was still about
// the same, or h times the rate at which compressed springs push to the side); and by trying, the
// largest of h/2, h/4, ... and the methods at this h that hold, for some `seconds` at most. Empty
// for other methods and outcomes.
std::string diagnosis(const Method& method, const Options& options, const ReducedScene& scene,
                      double until, const Summary& summary, double seconds);

}  // namespace qddot::measure
