#include "experiments/scaling/step_phases.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/measure/motion/timing.hpp"

namespace qddot::scaling {
namespace {

// A spring's k and l0 are read at each of its ends (see SpringsByNode). An unknown's q and weight
// are read, its f is written, and its position goes to memory and back.
constexpr double bytes_of_spring = 2 * 2 * sizeof(double);
constexpr double bytes_of_unknown = 5 * sizeof(double);
// Operations at each end. d = x_j - x_i: 3; l^2 = d.d: 5; l: 1; s = l - l0: 1; tau = k s: 1; tau/l:
// 1; f_i += (tau/l) d: 6.
constexpr double flops_of_spring = 2 * 18;

// The least time [s] of a timed run, unless that takes more than the most steps. Short runs are
// disturbed least.
constexpr double shortest_run = 5e-3;
constexpr double most_steps = 10000, least_steps = 3;
// The runs of which the least counts take this time together [s], or are this many.
constexpr double timed_together = 0.3;
constexpr int fewest_runs = 2;
// A first step of at least this time [s] counts as any other, and is the only one.
constexpr double own_warm_up = 5;

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

// The cost of a step of the run, without the forces beyond `forces` a step.
StepPhases phases_of(const Run& run, double forces) {
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

ForceRate force_rate(const ReducedScene& scene, double springs, double seconds) {
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  Vec f(system.size());
  return {
      .seconds = least_seconds(seconds, [&] { system.force(q, f); }),
      .bytes = bytes_of_spring * springs + bytes_of_unknown * static_cast<double>(system.size()),
      .flops = flops_of_spring * springs};
}

StepPhases step_phases(Integrator& integrator, double step_size, const ReducedScene& scene) {
  const Run first = run(integrator, step_size, 1, scene);
  const auto forces = [](const Run& r) {
    return static_cast<double>(r.summary.counts.force_evaluations);
  };
  if (first.summary.outcome != Outcome::reached_end || first.seconds >= own_warm_up) {
    return phases_of(first, forces(first));
  }
  const double steps = std::clamp(std::ceil(shortest_run / first.seconds), least_steps, most_steps);
  Run least;
  double spent = 0;
  for (int i = 0; i < fewest_runs || spent < timed_together; ++i) {
    Run next = run(integrator, step_size, steps, scene);
    if (next.summary.outcome != Outcome::reached_end) return phases_of(next, 0);
    spent += next.seconds;
    if (i == 0 || next.seconds < least.seconds) least = std::move(next);
  }
  return phases_of(least, (forces(least) - forces(first)) / (steps - 1));
}

}  // namespace qddot::scaling
