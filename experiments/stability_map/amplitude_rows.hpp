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

// The scene with each node's distance from its place at rest multiplied by each of the amplitudes,
// velocities likewise: 1 is `start` itself. Rows in which nothing moves or vibrates, or whose scene
// cannot exist, are left out; `left_out`, if any, gets a sentence with the reason for each.
std::vector<AmplitudeRow> scaled_rows(const Scene& start, const Scene& rest,
                                      const std::vector<double>& amplitudes,
                                      const Reductions& reductions,
                                      std::vector<std::string>* left_out = nullptr);

// The scenes that the generator of that name draws with its parameter `vary` at each of the values.
// Throws InvalidInput if there is no such generator or parameter, or no value is possible. Rows are
// as above; a scene without an equilibrium is left out as well.
std::vector<AmplitudeRow> varied_rows(const std::string& generator, const std::string& vary,
                                      const std::vector<double>& values,
                                      const Reductions& reductions,
                                      std::vector<std::string>* left_out = nullptr);

// The rows of the map: those of varied_rows if a parameter is named, else of scaled_rows if the
// scene has an equilibrium `rest`. Says on stderr which are left out.
std::vector<AmplitudeRow> rows_of(const Subject& subject, const Reductions& reductions,
                                  const std::optional<Scene>& rest, const std::string& vary,
                                  const std::vector<double>& amplitudes);

}  // namespace qddot::stability_map
