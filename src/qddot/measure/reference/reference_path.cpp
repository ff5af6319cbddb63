#include "qddot/measure/reference/reference_path.hpp"

#include <algorithm>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/reference/reference_ways.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// The states at these times by Kahan and Li's composition with steps of h [s]. The run ends with
// the reference, so that its steps are those of the reference.
std::vector<State> composed_path(const Model& scene, double h, double until,
                                 const std::vector<double>& times, double seconds) {
  std::vector<State> states;
  const Observer each{times, [&](const State& state) { states.push_back(state); }};
  State state = scene.initial();
  const Deadline deadline(seconds);
  const Summary summary =
      make_integrator(resolving_method(scene.system()), scene.system(), {.step_size = h})
          ->advance(state, until, each, deadline.token());
  stop_if_interrupted();
  if (summary.outcome != Outcome::reached_end) {
    throw NoReference(
        "no reference along the motion: the method did not reach the end in time: ask for an "
        "earlier end (--until)",
        true);
  }
  return states;
}

}  // namespace

ReferencePath path_of(const Model& scene, const Reference& reference,
                      const std::vector<double>& times, double seconds) {
  const double until = reference.end.t, h = reference.step_size;
  ReferencePath path{.states = composed_path(scene, h, until, times, seconds), .certified = {}};
  const auto finer = composed_path(scene, h / 2, until, times, seconds);
  double largest = machine_epsilon;
  for (std::size_t i = 0; i < times.size(); ++i) {
    State& state = path.states[i];
    if (times[i] == until) state = reference.end;
    largest = std::max(largest, 2 * position_error(scene, state, finer[i], reference.scales));
    path.certified.push_back(times[i] == until ? reference.certified.position : largest);
  }
  return path;
}

}  // namespace qddot::inline measure
