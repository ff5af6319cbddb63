#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::stability_map {

// The steps of an adaptive method on a slow motion beside a fast vibration almost at rest: q1'' =
// -q1 from (1, 0) and q2'' = -w^2 q2 from (0, 1e-6), over ten periods of q1. An explicit method
// still has to keep h w below its limit. It does so by a bound of w, or by rejecting steps once q2
// has grown to a visible size.
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
