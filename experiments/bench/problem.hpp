#pragma once

#include <algorithm>

#include <nlohmann/json_fwd.hpp>

#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::bench {

// A scene as a user gives it to a peer: M q'' = f(q) over the coordinates of the free nodes, in the
// order of the scene, without other reductions.
struct Problem {
  // `started`: the scene as its motion starts; `until`: end time [s]. The reference is kept in
  // `folder` with `drawn`, its scene, and `origin`. Throws InvalidInput if a free node has no mass,
  // or if the end is beyond the horizon of a chaotic motion, where the positions are unknown.
  // Throws NoReference.
  Problem(const Scene& drawn, const Scene& started, double until, const std::string& folder,
          const nlohmann::json& origin);

  // The position error of an end state (see Errors); infinite where it is no number.
  double error(const State& end) const;

  Scene start;
  double until;           // [s]
  ReducedScene smallest;  // with all reductions,
  Reference reference;    // made of that, in its unknowns
  ReducedScene scene;     // pins alone left out
  Reference own;          // the same reference in these unknowns
  double length, speed;   // what positions [m] and velocities [m/s] are large or small by
};

// Whether the spring moves a node.
inline bool has_free_end(const Scene& scene, const Spring& spring) {
  return !scene.nodes[spring.nodes[0]].pinned || !scene.nodes[spring.nodes[1]].pinned;
}

// Whether a spring of the scene is more than linear.
inline bool has_quartic(const Scene& scene) {
  return std::ranges::any_of(scene.springs,
                             [](const Spring& spring) { return spring.law.quartic != 0; });
}

// The state of all free nodes, in the unknowns of a scene that is reduced by pins alone.
State state_of(const std::vector<Node>& nodes, int dimension, double t);

}  // namespace qddot::bench
