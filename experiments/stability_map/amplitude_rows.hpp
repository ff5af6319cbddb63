#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"

namespace qddot::stability_map {

// A scene at one amplitude of its motion, and what linear theory knows of it.
struct AmplitudeRow {
  double amplitude;
  std::unique_ptr<ReducedScene> scene;
  double rest_energy;       // V at rest [J]
  double omega_max;         // at the start [rad/s]
  double buckling_rate;     // likewise [1/s], zero where nothing pushes to the side
  std::vector<Mode> modes;  // about the start
};

// The largest natural frequency [rad/s] at the start; zero where nothing vibrates.
double omega_max_of(const ReducedScene& scene);

// The scene with each node moved from its place at rest to each of the amplitudes times its
// distance from it, velocities likewise: 1 is `start` itself. Without the rows in which nothing
// moves or vibrates, and those whose scene cannot be: `left_out`, if any, gets the reason of each,
// a sentence.
std::vector<AmplitudeRow> scaled_rows(const Scene& start, const Scene& rest,
                                      const std::vector<double>& amplitudes,
                                      const Reductions& reductions,
                                      std::vector<std::string>* left_out = nullptr);

// The scene that the generator of that name draws with its parameter `vary` at each of the values.
// Throws InvalidInput where there is no such generator or parameter, or no value is possible. Rows
// as above; a scene without an equilibrium is left out as well.
std::vector<AmplitudeRow> varied_rows(const std::string& generator, const std::string& vary,
                                      const std::vector<double>& values,
                                      const Reductions& reductions,
                                      std::vector<std::string>* left_out = nullptr);

}  // namespace qddot::stability_map
