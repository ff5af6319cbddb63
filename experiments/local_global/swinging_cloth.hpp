#pragma once

#include <string>

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::local_global {

// Throws InvalidInput if the true motion of such a cloth over `duration` [s] takes more than 1e7
// steps (some hours). The message names `option`.
void require_reachable(int nodes, double stiffness, double duration, const std::string& option);

// A square cloth of 1 m and 1 kg, held at two corners, with `nodes` nodes along a side. Its springs
// have `stiffness` [N/m] between neighbours, half of it along diagonals, and a tenth of it between
// second neighbours. Its symmetry is not reduced. It has swung for `swing` s before the start.
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
