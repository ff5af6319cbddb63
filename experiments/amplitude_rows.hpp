#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/rest.hpp"
#include "experiments/scene_choice.hpp"

namespace qddot {

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
// moves or vibrates.
std::vector<AmplitudeRow> scaled_rows(const Scene& start, const Scene& rest,
                                      const std::vector<double>& amplitudes,
                                      const Reductions& reductions);

// The scene that the generator of that name draws with its parameter `vary` at each of the values.
// Throws InvalidInput where there is none, or a scene has no equilibrium. Rows as above.
std::vector<AmplitudeRow> varied_rows(const std::string& generator, const std::string& vary,
                                      const std::vector<double>& values,
                                      const Reductions& reductions);

}  // namespace qddot
