#pragma once

#include <string>

#include "qddot/scene/model.hpp"

namespace qddot::local_global {

// Throws InvalidInput unless the time t [s] is finite and at least 0.
void require_swing(double t, const std::string& option);

// Throws InvalidInput if the true motion of such a cloth over `duration` [s] takes more than 1e7
// steps (some hours). The message names `option`.
void require_reachable(int nodes, double stiffness, double duration, const std::string& option);

// A square cloth of 1 m and 1 kg, held at two corners, with `nodes` nodes along a side. Its springs
// have `stiffness` [N/m] between neighbours, half of it along diagonals, and a tenth of it between
// second neighbours. Its symmetry is not reduced. It has swung for `swing` s before the start.
struct SwingingCloth {
  SwingingCloth(int nodes, double stiffness, double swing);

  const System& system() const { return scene.system(); }
  // The motion from `state` after `duration` [s], by order 8, for the errors of implicit Euler.
  // Throws NoReference if it does not get there.
  State truth(const State& state, double duration) const;
  // The largest distance of a node [m].
  double distance(const State& a, const State& b) const;

  Scene drawn;
  Model scene;
  State start;
};

// Throws InvalidInput if runs of the cloth over `until` [s] take too many steps of h [s], or its
// true motion does.
void require_affordable(int nodes, double stiffness, double h, double until);

}  // namespace qddot::local_global
