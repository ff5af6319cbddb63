#pragma once

#include <string>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// A sentence on a run to `until` [s] that lost more than a twentieth of the energy that its motion
// can turn into speed (EnergyChange); empty for other runs. It says how much. By linear theory, it
// says to which damping ratios of the method that amounts at w_max and at the motion's own
// frequency, and which step takes a hundredth. The own frequency is seen in a repetition of the
// run. Methods that keep the energy at this step by theory are then tried, and named with what they
// took. All that ends after `seconds`.
std::string loss_warning(const Method& method, const Options& options, const Model& scene,
                         const Summary& summary, double until, double seconds);

}  // namespace qddot::inline measure
