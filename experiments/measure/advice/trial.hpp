#pragma once

#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/error.hpp"

namespace qddot::measure {

// What the accuracy of a run is judged by: the relative error of positions at its end, the largest
// on the way, or the largest error of the energy on the way over the largest kinetic energy.
enum class AccuracyOf { positions, path, energy };

// A whole run of a method, seen at the times of its stage.
struct Trial {
  const Method* method = nullptr;
  double value = 0;  // of its knob: h [s] or rtol
  Summary summary{};
  double seconds = 0;  // wall time of the run
  // At the times, the end last, as far as it came; or the end alone.
  std::vector<State> path{};

  double energy_gap = 0;   // largest |E - E(0)| at these times [J]
  bool is_gamble = false;  // made in the hope of chance: no other run is judged by it

  bool reached_end() const { return summary.outcome == Outcome::reached_end; }
};

// One motion, which trials are runs of: a model up to a time, seen at `looks` equal parts of that.
// Where positions at the end are all that is asked for, implicit methods of fixed steps are seen
// there alone: each look between two steps would be one more step, of another length.
class Stage {
 public:
  // Borrows the model.
  Stage(const ReducedScene& model, double until, AccuracyOf of, int looks);

  // Runs the method to the end, for so many seconds at most.
  Trial run(const Method& method, double value, double seconds) const;
  // The same from another start.
  Trial run_from(const State& start, const Method& method, double value, double seconds) const;
  // Runs a trial that came to the end in less than a millisecond again: its time is the least of
  // several.
  void time_again(Trial& trial) const;

  // Measures the motion by that trial, which came to the end: what errors are divided by from now
  // on. None are known before.
  void measure_by(const Trial& trial);

  // How far two trials that came to the end are apart, relative to the motion: at the end or, where
  // the path is asked for, at any of the times.
  double distance(const Trial& one, const Trial& other) const;
  // The same at each of the times; nothing where one of them was seen at the end alone.
  std::vector<double> distances(const Trial& one, const Trial& other) const;

  // The largest error of the energy at the times of a trial that came to the end, where the energy
  // is asked for.
  double energy_error(const Trial& trial) const;

  const ReducedScene& model() const { return model_; }
  double until() const { return until_; }
  const std::vector<double>& times() const { return times_; }
  const Scales& scales() const { return scales_; }

 private:
  const ReducedScene& model_;
  double until_;
  AccuracyOf of_;
  std::vector<double> times_;
  Scales scales_;
};

}  // namespace qddot::measure
