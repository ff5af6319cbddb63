#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::stability_map {

// What steps a method of adaptive steps takes where the motion that it sees is slow and a fast
// vibration is all but at rest beside it: q1'' = -q1 from (1, 0) and q2'' = -w^2 q2 from (0, 1e-6),
// over ten periods of the slow one. An explicit method has to hold h w below its limit all the
// same: by a bound of w, or else by steps that it rejects once q2 has grown to where it is seen.
struct ChosenSteps {
  Outcome outcome{};
  Counts counts{};
  double mean_h_omega = 0;  // of accepted steps, with w the fast frequency
  double rejected = 0;      // share of all steps
  double fast_energy = 0;   // at the end, over the whole of the start
  double energy_error = 0;  // of the slow vibration, likewise
};

ChosenSteps chosen_steps(const Method& method, double rtol, double omega);

}  // namespace qddot::stability_map
