#pragma once

#include <limits>
#include <vector>

#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// The magnitudes of the motion of one part of a scene over its run.
struct PartScale {
  std::vector<std::size_t> nodes{};  // of the scene
  double extent = 0;                 // largest coordinate of a node at the start [m]
  double displacement = 0;           // largest |x - x(0)| of a node [m]
  double speed = 0;                  // largest |v| of a node [m/s]

  // Whether it moves by less than 1e4 roundings of its coordinates, too little for four digits. It
  // is then at rest and gives no scale.
  bool is_at_rest() const;
};

// The scales of errors: magnitudes of a motion over its run. Motion in closed form has no error and
// counts only if nothing else moves. This is the motion of nodes in free flight, of parts that rest
// in their fall, and the common fall of a part without pins. Such a part is measured in the frame
// that falls with it.
struct Scales {
  double displacement = 0;  // largest |x - x(0)| of a node [m]
  double speed = 0;         // largest |v| of a node [m/s]
  // Largest kinetic energy of the integrated part, or what driving has let pass through it [J].
  double kinetic = 0;
  // The scales of each part of the scene; empty if the ones above hold for all nodes.
  std::vector<PartScale> parts{};

  // The scales of a part's errors of positions [m] and velocities [m/s]: its own, or the scene's if
  // the part is at rest.
  double displacement_of(const PartScale& part) const;
  double speed_of(const PartScale& part) const;
};

// Relative errors of a state against another at the same time, over all nodes of the scene. Each is
// divided by the scale of the node's part, and absolute if that scale is zero (nothing moves). NaN
// if not measured.
struct Errors {
  double position = std::numeric_limits<double>::quiet_NaN();  // max over nodes of |x - x_ref|
  double velocity = std::numeric_limits<double>::quiet_NaN();  // max over nodes of |v - v_ref|
  double energy = std::numeric_limits<double>::quiet_NaN();    // |E - E_ref|
};
constexpr Errors no_error = {.position = 0, .velocity = 0, .energy = 0};

// Extends the scales by one more state of the motion from `initial`.
void extend(Scales& scales, const Model& scene, const State& state);

// `energy`: E_ref [J].
Errors errors_between(const Model& scene, const State& state, const State& reference, double energy,
                      const Scales& scales);

// The position error alone, by scales of the same reduction of the scene.
double position_error(const Model& scene, const State& state, const State& reference,
                      const Scales& scales);
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
