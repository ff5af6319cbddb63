#pragma once

#include "qddot/measure/reference/reference_ways.hpp"

namespace qddot::measure {

// The start with each unknown moved at random: positions by up to `part` of what their part of the
// scene measures from the origin or moves, velocities by up to `part` of its speed. With the
// machine's epsilon, that is one rounding.
State displaced_start(const ReducedScene& scene, const Scales& scales, double part);

// A composition and the same from a start that is one rounding away and until one rounding later,
// and so what that does to the end.
class RoundingRun {
 public:
  // In `seconds` at most; there is no effect to tell where that is not enough.
  RoundingRun(const ReducedScene& scene, const Solution& composed, double until, double seconds);

  bool reached_end() const { return moved_.has_value(); }
  double knob() const { return knob_; }
  // On the end; of the energy, what the rounding of the start and of its own sum does to E(0).
  const Errors& effect() const { return effect_; }
  // Whether a change of the end by this much [worse of position and velocity] may be rounding
  // alone: each of N steps adds one, by chance to either side, which grow as sqrt(N); ten times
  // that.
  bool explains(double change) const;
  // Writes the horizon and what else is known of the parting of the two.
  void tell(Reference& reference) const;

 private:
  const ReducedScene& scene_;
  std::vector<State> path_;
  Scales scales_;
  double knob_, steps_;
  State start_;
  std::optional<Solution> moved_;
  Errors effect_;
  double growth_ = 0;
};

// What the composition's path, computed with the reductions of `scene`, has become in the same
// motion of all nodes of `start`, pushed by a rounding to all sides. Nothing where that takes
// longer than `seconds`.
std::optional<OutOfSymmetry> out_of_symmetry(const Scene& start, const ReducedScene& scene,
                                             const Solution& composed, double until,
                                             double seconds);

// Beyond the horizon, how the energy is divided: repeats the composition from a start that is
// known to half as many digits. As differences grow exponentially, that is apart in half the time:
// during all of the later half of a run beyond the horizon, in which the two have nothing in common
// but what every such motion has.
void measure_shares(Reference& reference, const ReducedScene& scene, const Solution& composed,
                    double until, double seconds);

}  // namespace qddot::measure
