#pragma once

#include "qddot/measure/reference/reference_ways.hpp"

namespace qddot::inline measure {

// Whether its motion is computed on a line, in a plane or with mirror symmetry. A push breaks that.
bool is_reduced_by_symmetry(const Model& scene);

// Repeats a composition from a start that is one rounding away, with steps that are two longer.
// Measures the effect on the end. If it grows much, the largest effect of three such starts counts.
class RoundingRun {
 public:
  // Each run takes `seconds` at most; if they are not enough, reached_end() is false and there is
  // no effect. `drawn`: the scene that `scene` is the reduction of, if known, so that pins are
  // rounded, too.
  RoundingRun(const Model& scene, const Solution& composed, double until, double seconds,
              const Scene* drawn);

  bool reached_end() const { return moved_.has_value(); }
  double knob() const { return knob_; }
  // The effect on the end. That of the energy is the effect on E(0) of rounding the start and of
  // rounding its own sum.
  const Errors& effect() const { return effect_; }
  // Whether a change of the end by this much [larger of position and velocity error] may be
  // rounding alone. The roundings of N steps, each of random sign, add up to sqrt(N) of one; the
  // limit is ten times that.
  bool explains(double change) const;
  // Writes the horizon, the exponent and the growth of the difference into the reference.
  void tell(Reference& reference) const;

 private:
  // False if the run takes too long. `reaching`: the scales, with extents that reach to pins.
  bool repeat(const Solution& composed, const Scales& reaching, std::uint32_t seed, double until,
              double seconds, const Scene* drawn);

  const Model& scene_;
  std::vector<State> path_;
  Scales scales_;
  double knob_, steps_;
  State start_;
  std::optional<Solution> moved_;
  Errors effect_ = no_error;
  double growth_ = 0;
};

// Compares the composition's path, computed with the reductions of `scene`, with a motion of all
// nodes of `start`. That begins with a push by one rounding in all dimensions. Empty if it takes
// longer than `seconds`.
std::optional<OutOfSymmetry> out_of_symmetry(const Scene& start, const Model& scene,
                                             const Solution& composed, double until,
                                             double seconds);

// Measures the modal shares of a motion beyond the horizon, and how much they differ by chance.
// Repeats the composition from a start that agrees to half as many digits. Differences grow
// exponentially, so the two are apart after half the time. So the second half of the run has only
// those properties in common that every such motion has.
void measure_shares(Reference& reference, const Model& scene, const Solution& composed,
                    double until, double seconds);

}  // namespace qddot::inline measure
