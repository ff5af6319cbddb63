#include "qddot/measure/trend/scene_trend.hpp"

#include "qddot/measure/motion/simulation.hpp"

namespace qddot::inline measure {

DriftRun energy_trend(const Scene& scene, const Method& method, const Options& options,
                      double until, double seconds) {
  constexpr double looks = 1e5;
  const Simulation run(scene, method, options);
  const Momenta momenta(scene);
  const double step = options.step_size > 0 ? options.step_size : until / looks;
  return run_drift(method, run.options(), run.model(), momenta,
                   motion_scales(run.model(), momenta, until), {step, until, seconds});
}

}  // namespace qddot::inline measure
