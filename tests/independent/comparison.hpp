#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/kit/plain_motion.hpp"
#include "qddot/scene/model.hpp"

namespace qddot {
inline namespace tests {

// A drawn scene's motion to its horizon by the independent model, and how well any code that rounds
// to double precision can know it.
class DrawnMotion {
 public:
  explicit DrawnMotion(const Scene& scene);

  const Scene& scene() const { return scene_; }
  double until() const { return *scene_.until; }
  // Up to when the motion is known [s]: `until`, or when a massless node lost its place. Zero where
  // it has none from the start, or where the motion takes too many steps.
  double known_until() const { return known_until_; }
  bool is_known() const { return known_until_ == until(); }

  // The larger of two errors at the end. One is the largest of a node's position over the largest
  // displacement, the other that of a velocity over the largest speed.
  double error(const std::vector<Node>& nodes) const;
  // The allowed error: a thousand times the effect of one rounding of the drawn positions and
  // velocities on the end. The roundings of some thousand steps have no larger effect.
  double floor() const { return floor_; }
  // The same difference between two ends.
  double difference(const std::vector<Node>& a, const std::vector<Node>& b) const;
  // The energy that damping has taken by the end [J], and the size of energies there.
  double dissipated() const { return static_cast<double>(end_.state().work.dissipated); }
  double driven() const {
    const PlainMotion<long double> start(scene_, 1);
    const auto& model = end_.model();
    const PlainState<long double> end = end_.state();
    return static_cast<double>(end.work.driven + model.energy_between_pins(end.x) -
                               model.energy_between_pins(start.state().x));
  }
  double energy_size() const { return energy_size_; }

 private:
  Scene scene_;
  PlainMotion<long double> end_;
  double known_until_ = 0, displacement_ = 0, speed_ = 0, floor_ = 0, energy_size_ = 0;
};

// The quantities that are compared with the drawn scene, and the number of comparisons.
struct Comparisons {
  std::int64_t states = 0, motions = 0, runs = 0;
  std::int64_t given_up = 0;  // runs whose nonlinear or linear solves failed, and said so
  std::vector<std::string> disagreements;  // a sentence each

  Comparisons& operator+=(const Comparisons& more);
};

// Compares energies and force of the reduced scene with those of all drawn nodes, at the start and
// near it. The sets of reductions are each alone, all but each, all and none.
Comparisons compare_states(const Scene& scene, std::uint64_t seed);

// The motion with the same sets of reductions, by one method of high order.
Comparisons compare_reductions(const DrawnMotion& motion);

// Compares the motion by every method that can run the reduced scene, at three values of its knob.
// Their errors must fall as their differences do.
Comparisons compare_methods(const DrawnMotion& motion);

}  // namespace tests
}  // namespace qddot
