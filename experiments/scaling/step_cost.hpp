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

// Measures the cost of a step of `step_size` [s] from the scene's start. After one step to warm up,
// it repeats runs long enough for the clock; the fastest counts. A first step of some seconds is
// not repeated. Forces before the first step are subtracted.
StepCost step_cost(Integrator& integrator, double step_size, const ReducedScene& scene);

}  // namespace qddot::scaling
