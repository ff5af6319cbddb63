#pragma once

#include <string>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::scaling {

// What a step of a method costs on the mean over a run of some [s].
struct StepCost {
  Outcome outcome{};  // what follows means something only where it is reached_end
  std::string message;
  double total = 0;  // wall time
  Seconds parts;     // of it
  double rest() const {
    return total - parts.force - parts.stiffness - parts.factorization - parts.solve;
  }
};

// Runs steps of that size [s] from the scene's start: one to warm up, then again and again as many
// as the clock needs, of which the fastest run counts; a first step of some seconds is taken as it
// is. Forces before the first step belong to no step and are taken off.
StepCost step_cost(Integrator& integrator, double step_size, const ReducedScene& scene);

}  // namespace qddot::scaling
