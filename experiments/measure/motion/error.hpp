#pragma once

#include <vector>

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::measure {

// How far one part of a scene moves over its run.
struct PartScale {
  std::vector<std::size_t> nodes{};  // of the scene
  double extent = 0;                 // largest coordinate of a node at the start [m]
  double displacement = 0;           // largest |x - x(0)| of a node [m]
  double speed = 0;                  // largest |v| of a node [m/s]

  // Whether it moves by so few roundings of its coordinates (1e4) that nobody could tell four
  // digits of that: it stands, and has no motion to measure errors by.
  bool is_at_rest() const;
};

// What errors are measured against: magnitudes of a motion over its run. What moves in closed form
// counts only where nothing else moves, as it has no error: neither nodes in free flight and parts
// that rest in their fall, nor the common fall of a part without pins, which is measured in the
// frame that falls with it.
struct Scales {
  double displacement = 0;  // largest |x - x(0)| of a node [m]
  double speed = 0;         // largest |v| of a node [m/s]
  double kinetic = 0;       // largest kinetic energy of what is integrated [J]
  // The scales of each part of the scene; empty where the ones above hold for all nodes.
  std::vector<PartScale> parts{};

  // What errors of a part's positions [m] and velocities [m/s] are divided by: its own scale or,
  // where it is at rest, the scene's.
  double displacement_of(const PartScale& part) const;
  double speed_of(const PartScale& part) const;
};

// Errors of a state against another at the same time, over all nodes of the scene, whatever its
// unknowns are; each divided by the scale of the node's part, or as it is where that is zero
// (nothing moves).
struct Errors {
  double position = 0;  // max over nodes of |x - x_ref|
  double velocity = 0;  // max over nodes of |v - v_ref|
  double energy = 0;    // |E - E_ref|
};

// Takes one more state of the motion from `initial` into the scales.
void extend(Scales& scales, const ReducedScene& scene, const State& state);

// `energy`: E_ref [J].
Errors errors_between(const ReducedScene& scene, const State& state, const State& reference,
                      double energy, const Scales& scales);

// The position error alone, of all nodes of the scene, and that of the velocities.
double position_error(const std::vector<Node>& nodes, const std::vector<Node>& reference,
                      const Scales& scales);
double velocity_error(const std::vector<Node>& nodes, const std::vector<Node>& reference,
                      const Scales& scales);

// The larger of the two of positions and velocities.
double worse(const Errors& errors);
// The larger of each.
Errors larger(const Errors& one, const Errors& other);

}  // namespace qddot::measure
