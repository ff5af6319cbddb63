#pragma once

#include <optional>
#include <string>
#include <vector>

#include "qddot/measure/advice/forecast.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline measure {

// The advice for one accuracy.
struct Advice {
  double accuracy = 0;
  // The run to take, which was made: its error is a bound. Empty if no run is known to reach the
  // accuracy; `why` then says the reason.
  std::optional<Candidate> take{};
  std::string why{};
  // The fastest of the other methods, and the fastest of each family, where known.
  std::optional<Candidate> runner_up{}, own_explicit{}, own_implicit{}, sundials{};

  // The runner-up's time over that of the run to take; infinite without a runner-up. It is 1 if the
  // runner-up may be a little faster but was not seen to be accurate enough.
  double margin() const;
};

// The advice for a scene, and the properties of its motion that decide it.
struct Advices {
  std::vector<Advice> for_each{};  // accuracy, in the order in which they were asked for
  // The largest frequency [rad/s] at the start and over the motion; the motion's own one for
  // methods of order 2 (see OwnFrequencies).
  double w_start = 0, w_motion = 0, own_frequency = 0;
  // Verlet's largest stable step over the motion [s]; infinite where nothing vibrates.
  double largest_stable_step = 0;
  // The rate [1/s] at which two nearby runs part, and the time [s] from which they have nothing in
  // common. Zero and infinite if no such parting was seen.
  double lyapunov = 0, horizon = 0;
  int runs = 0;
  double seconds = 0;  // the time [s] that the advice took
};

// Finds the method that reaches each accuracy in the least time. An accuracy is a relative error:
// of the positions at `until` [s], or as `of` says. All runs that it names were made and judged, as
// in solve(). `drawn` is as there. Throws as solve() does.
Advices advise(const Model& model, double until, const std::vector<double>& accuracies,
               AccuracyOf of = AccuracyOf::positions, const Scene* drawn = nullptr);
Advices advise(const Scene& scene, double until, const std::vector<double>& accuracies,
               AccuracyOf of = AccuracyOf::positions);

}  // namespace qddot::inline measure
