#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"

namespace qddot::stability_map {

// A scene at one amplitude of its motion, and its properties by linear theory.
struct AmplitudeRow {
  double amplitude;
  std::unique_ptr<ReducedScene> scene;
  double rest_energy;       // V at rest [J]
  double omega_max;         // at the start [rad/s]
  double buckling_rate;     // likewise [1/s], zero if no spring pushes sideways
  std::vector<Mode> modes;  // about the start
};

// The largest natural frequency [rad/s] at the start; zero if nothing vibrates.
double omega_max_of(const ReducedScene& scene);

// The scenes that the scene's generator draws with its parameter `vary` at each of the amplitudes.
// Throws InvalidInput if there is no such generator or parameter, or no amplitude is possible. If
// `vary` is empty: the scene with each node's distance from its place at rest multiplied by each of
// them, velocities likewise, so that 1 is the scene itself; none without an equilibrium `rest`.
// Rows in which nothing moves or vibrates, or whose scene cannot exist or has no equilibrium, are
// left out, which stderr says.
std::vector<AmplitudeRow> rows_of(const Subject& subject, const Reductions& reductions,
                                  const std::optional<Scene>& rest, const std::string& vary,
                                  const std::vector<double>& amplitudes);

}  // namespace qddot::stability_map
