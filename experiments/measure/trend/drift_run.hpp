#pragma once

#include <optional>
#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/trend/energy_trend.hpp"
#include "qddot/measure/trend/motion_scales.hpp"

namespace qddot::measure {

// How the invariants of a run are looked at.
struct DriftPlan {
  double step_size = 0,
         until = 0;     // [s]; adaptive methods are looked at at multiples of it as well
  double seconds = 10;  // that the run may take
};

struct DriftPoint {
  double t = 0, energy = 0, error = 0;  // [s], [J], relative
};

// One method's run, and what became of the scene's invariants in it.
struct DriftRun {
  const Method* method = nullptr;
  double value = 0;  // of its knob
  Summary summary{};
  double seconds = 0;
  TrendScales scales{};
  Trend energy{};
  // The trend of the component that changed most, where there is one that should stay.
  std::optional<Trend> linear{}, angular{};
  std::vector<DriftPoint> path{};  // from t = 0 on, some in each octave and some at equal distances
};

// Runs the method on the scene. Energy errors are (E(t) - E(0)) / scales.kinetic, those of momenta
// relative to scales.linear and angular.
DriftRun run_drift(const Method& method, const Options& options, const ReducedScene& scene,
                   const Momenta& momenta, const MotionScales& scales, const DriftPlan& plan);

// The verdict on its energy: unknown where the run ended before half of `until`, unless it blew up
// or nearly all of its energy was gone.
Verdict verdict_at(const DriftRun& run, double until);

// The same in words, with how far it came and what became of the energy until then.
std::string verdict(const DriftRun& run, double until);

}  // namespace qddot::measure
