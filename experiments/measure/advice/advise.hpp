#pragma once

#include <optional>
#include <string>
#include <vector>

#include "qddot/measure/advice/forecast.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::measure {

// What to take for one accuracy.
struct Advice {
  double accuracy = 0;
  // The run to take; nothing where none is expected to come so far, and `why` says what stands
  // against it.
  std::optional<Candidate> take{};
  std::string why{};
  bool is_seen = false;  // the error is not expected but was seen, in a run and its check
  // The fastest of the other methods, and the fastest of each family, where known.
  std::optional<Candidate> runner_up{}, own_explicit{}, own_implicit{}, sundials{};

  // How many times as long the runner-up takes; infinite where there is none. 1 where it may be a
  // little faster, but was not seen to be so accurate.
  double margin() const;
};

// What a scene asks of a method, and which one to take.
struct Advices {
  std::vector<Advice> for_each{};  // accuracy, in the order in which they were asked for
  // The largest frequency [rad/s] at the start and over the motion; the motion's own one for
  // methods of order 2 (see OwnFrequencies).
  double w_start = 0, w_motion = 0, own_frequency = 0;
  // Verlet's largest stable step over the motion [s]; infinite where nothing vibrates.
  double largest_stable_step = 0;
  // How fast two nearby runs part [1/s], and from when on [s] they have nothing in common; zero and
  // infinite where that was not seen.
  double lyapunov = 0, horizon = 0;
  int runs = 0;
  double seconds = 0;  // that it took
};

// Says which method comes to each of the accuracies, of the positions at `until` [s] or as `of`
// says, in the least time. Makes no more runs than that asks for: at most half a second, or up to
// about twice the run that is advised. Throws as solve() does.
Advices advise(const ReducedScene& model, double until, const std::vector<double>& accuracies,
               AccuracyOf of = AccuracyOf::positions);
Advices advise(const Scene& scene, double until, const std::vector<double>& accuracies,
               AccuracyOf of = AccuracyOf::positions);

}  // namespace qddot::measure
