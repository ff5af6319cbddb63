#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/trend/energy_trend.hpp"
#include "qddot/measure/trend/motion_scales.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline measure {

// The times and the limit of a drift measurement.
struct DriftPlan {
  double step_size = 0,
         until = 0;     // [s]; adaptive methods too are measured at multiples of step_size
  double seconds = 10;  // limit of the run's wall time [s]
};

struct DriftPoint {
  double t = 0, energy = 0, error = 0;  // [s], [J], relative
};

// A run of one method, and the trends of the scene's invariants in it.
struct DriftRun {
  const Method* method = nullptr;
  double value = 0;  // of its knob
  Summary summary{};
  double seconds = 0;
  TrendScales scales{};
  Trend energy{};
  // The trend of the momentum component that changed most; empty if none is conserved.
  std::optional<Trend> linear{}, angular{};
  std::vector<DriftPoint> path{};  // from t = 0 on, some in each octave and some at equal distances
};

// Runs the method on the scene. Energy errors are (E(t) - E(0)) / scales.kinetic; errors of momenta
// are divided by scales.linear and scales.angular.
DriftRun run_drift(const Method& method, const Options& options, const Model& scene,
                   const Momenta& momenta, const MotionScales& scales, const DriftPlan& plan);

// The verdict on the run's energy. It is `unknown` if the run ended before until/2 [s], unless it
// blew up or nearly all of its energy was lost.
Verdict verdict_at(const DriftRun& run, double until);

// The same in words. If the run ended early, it says when, and the energy's trend until then.
std::string verdict(const DriftRun& run, double until);

// Runs the method on the scene to the time `until` [s], for `seconds` of wall time at most.
// Returns the trends of its energy and momenta. Samples are some thousands of multiples of
// options.step_size, also for adaptive methods, whose default is until/1e5. Throws as Simulation
// does.
DriftRun energy_trend(const Scene& scene, const Method& method, const Options& options,
                      double until, double seconds = 60);
// The same for a model that others share, as one of the caller's own forces is, with the momenta
// that are known to be conserved. It needs V, and K only if the method does.
DriftRun energy_trend(std::shared_ptr<const Model> model, const Momenta& momenta,
                      const Method& method, const Options& options, double until,
                      double seconds = 60);

}  // namespace qddot::inline measure
