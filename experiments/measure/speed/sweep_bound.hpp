#pragma once

#include <map>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::measure {

// The most wall time [s] that a point takes in all whose run takes `run` [s], set-up left out: what
// measure_point does with it under these limits.
double point_seconds_at_most(double run, const Effort& effort);

// The most wall time that sweeps take (see sweep.hpp), by what limits them: the knob's values,
// Effort::seconds, and that a run of fixed steps takes time in proportion to their number, by which
// sweep itself gives up runs. Borrows the scene.
class SweepBound {
 public:
  SweepBound(const ReducedScene& scene, double until, const Effort& effort);

  // Learns from a point of any method, which took so many seconds in all, what a force and a set-up
  // take here, and how much longer points take than their runs say.
  void learn(const Point& point, double seconds);
  // The most seconds that the whole sweep of the method takes.
  double whole(const Method& method) const;
  // The most that is left of it after so many points, which took `spent` [s].
  double left(const Method& method, int points, double spent) const;

 private:
  double point(double run) const;
  double step(const Method& method) const;
  double near_limit(const Method& method) const;

  const ReducedScene* scene_;
  double until_;
  Effort effort_;
  double setup_ = 0;   // the longest so far [s]
  double slower_ = 1;  // the largest such factor so far
  double w_ = 0;       // no less than w_max at the start [rad/s]
  double force_ = 0;   // the longest of explicit steps so far [s], with its share of the step
  double step_ = 0;    // the longest of other fixed steps so far [s]
  mutable std::map<const Method*, double> forces_;  // that explicit steps take each
};

}  // namespace qddot::measure
