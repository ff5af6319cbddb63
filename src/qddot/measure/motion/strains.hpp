#pragma once

#include <vector>

#include "qddot/algebra/constraint_forces.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// An extreme value on the way of a run, and its time [s].
struct Extreme {
  double value = 0, t = 0;
};

// The extremes of one spring's strain (l - l0)/l0 and tension tau + c l' [N], positive where it
// pulls. The strain of a spring of rest length zero is NaN.
struct SpringExtremes {
  Extreme largest_strain, smallest_strain, largest_tension, smallest_tension;
};

// Watches the strains and tensions of all springs of a scene on the way of a run. Between two steps
// each spring follows the cubic in time through the places and velocities of its ends, which has
// an error of order 4. Rods have the strain zero, and the tensions of their multipliers at the ends
// of steps alone.
class Strains {
 public:
  // Borrows both, which must outlive it. `scene`: the one that the model is the reduction of.
  Strains(const Scene& scene, const Model& model);

  // Takes the start, and then each accepted step of the run.
  void see(const State& state);
  // The extremes so far, spring after spring. A broken spring has those up to its breaking.
  const std::vector<SpringExtremes>& extremes() const { return extremes_; }

 private:
  void see_rods(const State& state);
  void see_spring(std::size_t e, double t, const Eigen::Vector3d& d, const Eigen::Vector3d& rate);

  const Scene& scene_;
  const Model& model_;
  std::vector<Node> before_, now_;
  double t_before_ = 0;
  std::vector<SpringExtremes> extremes_;
  std::vector<bool> is_broken_;
  ConstraintForces rods_;
};

}  // namespace qddot::inline measure
