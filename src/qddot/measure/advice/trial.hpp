#pragma once

#include <optional>
#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/error.hpp"
#include "qddot/measure/reference/divergence.hpp"

namespace qddot::inline measure {

// The error that an accuracy bounds: of the positions at the end, of the positions at any time, or
// of the energy at any time over the largest kinetic energy.
enum class AccuracyOf { positions, path, energy };

// A whole run of a method, seen at the times of its stage.
struct Trial {
  const Method* method = nullptr;
  double value = 0;  // of its knob: h [s] or rtol
  Summary summary{};
  double seconds = 0;  // wall time of the run
  // States at the times that the run reached, the end last; or the end alone.
  std::vector<State> path{};

  double energy_gap = 0;   // largest |E - E(0)| at these times [J]
  bool is_gamble = false;  // may be right by chance; checks no other run

  bool reached_end() const { return summary.outcome == Outcome::reached_end; }
};

// The motion that trials compute: a model up to a time, seen at the ends of `looks` equal parts of
// that time. Implicit methods of fixed steps are seen at the end alone if only positions there are
// asked for: a look between two steps would add a step of another length.
class Stage {
 public:
  // Borrows the model.
  Stage(const ReducedScene& model, double until, AccuracyOf of, int looks);

  // Runs the method to the end, for `seconds` at most.
  Trial run(const Method& method, double value, double seconds) const;
  // The same from another start.
  Trial run_from(const State& start, const Method& method, double value, double seconds) const;
  // Repeats a trial that reached the end in less than a millisecond; its time becomes the least of
  // several runs.
  void time_again(Trial& trial) const;

  // Takes the scales of errors from the trial, which reached the end. Errors need this first.
  void measure_by(const Trial& trial);

  // The distance of two trials that reached the end, relative to the motion. It is the one at the
  // end, or the largest at any of the times if the path is asked for.
  double distance(const Trial& one, const Trial& other) const;
  // The distance at each of the times; empty if one of the two was seen at the end alone.
  std::vector<double> distances(const Trial& one, const Trial& other) const;

  // The largest relative error of the energy at the times of a trial that reached the end, if the
  // energy is asked for.
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

// Repeats the trial from a start that is one rounding away, for `seconds` at most, and measures how
// the two part. Empty if the repetition does not reach the end.
std::optional<Divergence> parting_of_twins(const Stage& stage, const Trial& trial, double seconds);

}  // namespace qddot::inline measure
