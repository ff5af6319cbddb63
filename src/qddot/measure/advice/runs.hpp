#pragma once

#include <deque>
#include <map>
#include <utility>

#include "qddot/measure/advice/trial.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::inline measure {

// The runs of a search, in the order in which they were made, and their distances.
class Runs {
 public:
  // As Stage. No run begins after `seconds`.
  Runs(const Model& model, double until, AccuracyOf of, double seconds, const Scene* drawn,
       const Rules& rules);

  // Makes a run.
  const Trial& make(const Method& method, double value, const Limits& limits = {});
  // Repeats a run that is short, as its time is to be compared with another's.
  void time_again(const Trial& run);
  // Makes it from a start that is pushed.
  const Trial& make_pushed(const Method& method, double value, const Push& push = {});
  // The run that was made before and seen at all looks; nullptr if there is none.
  const Trial* find(const Method& method, double value, bool is_pushed = false) const;
  // Whether it was made before, and seen at its end at least.
  bool has(const Method& method, double value) const;

  // Looks also within the steps of that run, which is none of these. Call before the first one.
  void look_within_steps(const Method& method, double value);

  // As Stage. Call before the first run.
  void begin_in_balance(const Method& method) { stage_.begin_in_balance(method); }

  // Measures all distances by the scales of the trial, which reached the end.
  void measure_by(const Trial& trial);
  // The distance of two runs that reached the end, as Stage says.
  double distance(const Trial& one, const Trial& other) const;
  // The largest distance in the second half, or at any look if the path is asked for. Two runs may
  // meet at the end by chance.
  double distance_on_the_way(const Trial& one, const Trial& other) const;

  const std::deque<Trial>& all() const { return all_; }
  const Stage& stage() const { return stage_; }
  const Rules& rules() const { return stage_.rules(); }
  // Bounds of the largest frequency at the start [rad/s], and of the steps of Verlet's method.
  double bound_of_w() const { return bound_of_w_; }
  double steps_of_verlet() const { return steps_of_verlet_; }
  // The work of evaluating f once, and how often a run did: the mean over its parts.
  double work_of_force() const { return work_of_force_; }
  double forces(const Trial& trial) const;
  // Whether the run reached the end with no more energy than an accurate one may gain.
  bool is_sound(const Trial& trial) const {
    return trial.reached_end() && trial.summary.energy_growth < rules().doubt;
  }
  // The number of places at which a motion is looked at if each look costs so many forces. Together
  // they cost a small part of Verlet's run, beside two of them.
  std::size_t places(double forces) const;
  // The number of forces that are so much work.
  std::int64_t forces_within(double work) const;
  double seconds() const { return seconds_since(begin_); }
  double seconds_left() const;

 private:
  bool is_run(const Trial& trial, const Method& method, double value, bool is_pushed) const;

  double limit_;
  std::chrono::steady_clock::time_point begin_ = clock_now();
  double bound_of_w_, steps_of_verlet_, parts_, work_of_force_;
  Stage stage_;
  std::deque<Trial> all_;
  mutable std::map<std::pair<const Trial*, const Trial*>, double> distances_;  // by these scales
};

}  // namespace qddot::inline measure
