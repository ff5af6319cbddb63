#pragma once

#include <map>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline measure {

// An upper bound of the wall time [s] of a point whose run takes `run` [s], without set-up: the
// time of all its runs in measure_point.
double point_seconds_at_most(double run, const Effort& effort);

// Upper bounds of the wall time of sweeps (see ladder_points.hpp). They follow from the values of
// the knob, from Effort::seconds and from the numbers of steps. The time of a run of fixed steps is
// proportional to its steps, which measure_ladder() itself relies on to give up runs. Borrows the
// scene.
class SweepBound {
 public:
  SweepBound(const ReducedScene& scene, double until, const Effort& effort);

  // Learns from a point of any method that took `seconds` in all. It learns the times of a force
  // and of a set-up, and how much longer points take than their runs suggest.
  void learn(const Point& point, double seconds);
  // An upper bound of the time of the whole sweep of the method [s].
  double whole(const Method& method) const;
  // The same for the rest of it [s], after `points` points that took `spent` [s].
  double left(const Method& method, int points, double spent) const;

 private:
  double point(double run) const;
  double step(const Method& method) const;
  double near_limit(const Method& method) const;

  const ReducedScene* scene_;
  double until_;
  Effort effort_;
  double setup_ = 0;   // the longest so far [s]
  double slower_ = 1;  // largest time of a point over the expected one
  double w_ = 0;       // no less than w_max at the start [rad/s]
  double force_ = 0;   // the longest of explicit steps so far [s], with its share of the step
  double step_ = 0;    // the longest of other fixed steps so far [s]
  mutable std::map<const Method*, double> forces_;  // forces of an explicit step
};

}  // namespace qddot::inline measure
