#include "experiments/step_cost.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/timing.hpp"

namespace qddot {
namespace {

// A timed run is at least so long [s], if that takes no more than so many steps.
constexpr double shortest_run = 0.05;
constexpr double most_steps = 10000, least_steps = 3;
constexpr int repeats = 5;
// A first step at least so long [s] is as good as any other, and the only one.
constexpr double own_warm_up = 1;

struct Run {
  Summary summary;
  double seconds;
};

Run run(Integrator& integrator, double step_size, double steps, const ReducedScene& scene) {
  State state = scene.initial();
  Run result;
  result.seconds =
      seconds_of([&] { result.summary = integrator.advance(state, steps * step_size); });
  return result;
}

// Of a run, without the forces beyond `forces` a step.
StepCost cost_of(const Run& run, double forces) {
  const double steps = static_cast<double>(run.summary.counts.steps);
  const double all = static_cast<double>(run.summary.counts.force_evaluations);
  const auto& [force, stiffness, factorization, solve] = run.summary.seconds;
  const double before = all > 0 ? force * (1 - forces * steps / all) : 0;
  return {run.summary.outcome,
          run.summary.message,
          (run.seconds - before) / steps,
          {(force - before) / steps, stiffness / steps, factorization / steps, solve / steps}};
}

}  // namespace

StepCost step_cost(Integrator& integrator, double step_size, const ReducedScene& scene) {
  const Run first = run(integrator, step_size, 1, scene);
  const auto forces = [](const Run& r) {
    return static_cast<double>(r.summary.counts.force_evaluations);
  };
  if (first.summary.outcome != Outcome::reached_end || first.seconds >= own_warm_up) {
    return cost_of(first, forces(first));
  }
  const double steps = std::clamp(std::ceil(shortest_run / first.seconds), least_steps, most_steps);
  std::vector<Run> runs;
  for (int i = 0; i < repeats; ++i) {
    runs.push_back(run(integrator, step_size, steps, scene));
    if (runs.back().summary.outcome != Outcome::reached_end) return cost_of(runs.back(), 0);
  }
  const auto middle = runs.begin() + repeats / 2;
  std::ranges::nth_element(runs, middle, {}, &Run::seconds);
  return cost_of(*middle, (forces(*middle) - forces(first)) / (steps - 1));
}

}  // namespace qddot
