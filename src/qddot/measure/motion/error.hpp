#pragma once

#include <vector>

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::inline measure {

// How far and how fast one part of a scene moves over its run.
struct PartScale {
  std::vector<std::size_t> nodes{};  // of the scene
  double extent = 0;                 // largest coordinate of a node at the start [m]
  double displacement = 0;           // largest |x - x(0)| of a node [m]
  double speed = 0;                  // largest |v| of a node [m/s]

  // Whether it moves by less than 1e4 roundings of its coordinates, too little for four digits: it
  // rests, and has no motion to measure errors by.
  bool is_at_rest() const;
};

// What errors are divided by: magnitudes of a motion over its run. Motion in closed form has no
// error and counts only if nothing else moves. That is the motion of nodes in free flight, of parts
// that rest in their fall, and the common fall of a part without pins. Such a part is measured in
// the frame that falls with it.
struct Scales {
  double displacement = 0;  // largest |x - x(0)| of a node [m]
  double speed = 0;         // largest |v| of a node [m/s]
  double kinetic = 0;       // largest kinetic energy of the integrated part [J]
  // The scales of each part of the scene; empty if the ones above hold for all nodes.
  std::vector<PartScale> parts{};

  // What errors of a part's positions [m] and velocities [m/s] are divided by: its own scale, or
  // the scene's if the part is at rest.
  double displacement_of(const PartScale& part) const;
  double speed_of(const PartScale& part) const;
};

// Relative errors of a state against another at the same time, over all nodes of the scene. Each is
// divided by the scale of the node's part, and absolute if that scale is zero (nothing moves).
struct Errors {
  double position = 0;  // max over nodes of |x - x_ref|
  double velocity = 0;  // max over nodes of |v - v_ref|
  double energy = 0;    // |E - E_ref|
};

// Extends the scales by one more state of the motion from `initial`.
void extend(Scales& scales, const ReducedScene& scene, const State& state);

// `energy`: E_ref [J].
Errors errors_between(const ReducedScene& scene, const State& state, const State& reference,
                      double energy, const Scales& scales);

// The position error and the velocity error alone, over all nodes of the scene.
double position_error(const std::vector<Node>& nodes, const std::vector<Node>& reference,
                      const Scales& scales);
double velocity_error(const std::vector<Node>& nodes, const std::vector<Node>& reference,
                      const Scales& scales);

// The larger of the errors of positions and of velocities.
double worse(const Errors& errors);
// The larger error of each kind.
Errors larger(const Errors& one, const Errors& other);

}  // namespace qddot::inline measure
