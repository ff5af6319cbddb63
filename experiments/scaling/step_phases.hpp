#pragma once

#include <string>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::scaling {

// The rate at which f(q) is evaluated, and the traffic and work of one evaluation.
struct ForceRate {
  double seconds = 0;  // of one evaluation
  // The bytes that one evaluation must move, each array once, and its operations (a root and a
  // division are one each). The bytes are also the working set.
  double bytes = 0, flops = 0;
};

// The fastest of evaluations of `seconds` at the scene's start. `springs`: how many of them move.
ForceRate force_rate(const ReducedScene& scene, double springs, double seconds);

// The times of a step of a method and of its phases [s], on the mean over a run.
struct StepPhases {
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
StepPhases step_phases(Integrator& integrator, double step_size, const ReducedScene& scene);

}  // namespace qddot::scaling
