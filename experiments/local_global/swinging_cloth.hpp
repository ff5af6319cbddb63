#pragma once

#include <string>

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::local_global {

// Throws InvalidInput, which names the option that asks for it, where the true motion of such a
// cloth over `duration` [s] takes more steps than 1e7, some hours.
void require_reachable(int nodes, double stiffness, double duration, const std::string& option);

// A square cloth of 1 m and 1 kg on two corners, `nodes` along a side, with springs of `stiffness`
// [N/m] between neighbours, half of it along diagonals and a tenth between second neighbours; all
// of it, as a scene without its symmetry would be. It has swung for `swing` s before the start.
struct SwingingCloth {
  SwingingCloth(int nodes, double stiffness, double swing);

  const System& system() const { return scene.system(); }
  // Where the motion from `state` is after `duration` [s], by order 8: what the errors of implicit
  // Euler are seen against. Throws NoReference where it is not reached.
  State truth(const State& state, double duration) const;
  // The largest distance of a node [m].
  double distance(const State& a, const State& b) const;

  Scene drawn;
  ReducedScene scene;
  State start;
};

}  // namespace qddot::local_global
