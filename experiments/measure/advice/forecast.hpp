#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "qddot/measure/advice/own_frequencies.hpp"
#include "qddot/measure/advice/trial.hpp"

namespace qddot::measure {

// A run that might be made: what it is expected to miss by and to take.
struct Candidate {
  const Method* method = nullptr;
  double value = 0;    // of the knob: h [s] or rtol
  double error = 0;    // expected
  double seconds = 0;  // expected
};

// The power of the knob that the error goes with.
double power_of_error(const Method& method);

// Methods that take stiff forces apart have steps within their steps, which finer steps refine no
// further: two runs may agree to less than this, and both be off by as much.
constexpr double least_of_split = 3e-8;

// What the method `exact` takes on the model [s], about; infinite where it does not run it.
double seconds_of_exact(const ReducedScene& model);

// Says of runs that were not made what they will miss by and take, from what is known of a motion:
//   error = sensitivity * frequency_error(method, h w_p),   seconds = steps * seconds of a step,
// with w_p the motion's own frequency of the method's order p. The sensitivity is at first that of
// a motion in which errors add up, |q'| t / |q - q(0)|; with each run whose error was seen, it is
// corrected for that method, for others of its order, and of the orders next to it. Nothing is
// expected of methods that choose their steps, or take stiff forces apart, before one run was seen;
// from there on the error goes as h^order or as rtol.
class Forecast {
 public:
  // Borrows the stage. `w_motion`: the largest frequency over the motion [rad/s], zero where
  // nothing vibrates. `step_seconds`: of Verlet's method.
  Forecast(const Stage& stage, const OwnFrequencies& own, double w_motion, double step_seconds);

  // `value`: of the knob, h [s] or rtol. The error is what the method leaves out (truncation) and
  // what rounding adds with each step; infinite where nothing is known.
  double error(const Method& method, double value) const;
  double truncation(const Method& method, double value) const;
  double rounding(const Method& method, double value) const;
  double seconds(const Method& method, double value) const;
  // By what factor the ratio of the errors of two methods may be another than is expected, one of
  // `doubts`: none for two runs of one method, little where runs of both were seen.
  static constexpr std::array doubts = {1.0, 1.5, 4.0};
  double doubt(const Method& one, const Method& other) const;
  // The runs that are expected to come to that error, one a method, the fastest first; of all
  // methods or of the explicit ones of fixed steps.
  std::vector<Candidate> candidates(double error, bool explicit_steps = false) const;
  // The same, to an error of its own for each method.
  std::vector<Candidate> candidates(const std::function<double(const Method&)>& error,
                                    bool explicit_steps = false) const;

  // Takes in what a better run says of the motion's own frequencies, and forgets the errors that
  // were seen: they are to be learned anew.
  void learn_frequencies(const OwnFrequencies& own);
  // Whether the error of a run of the method, or of an explicit one of its order, was seen.
  bool has_learned(const Method& method) const;
  // Whether the error of a run of the method itself was seen.
  bool has_seen(const Method& method) const;
  // Takes in that a run missed by so much, and what it took.
  void learn_error(const Trial& trial, double error);
  void learn_seconds(const Trial& trial);
  // Takes in that a run of fixed steps did not hold: none of the method is expected to that is as
  // coarse.
  void learn_failure(const Trial& trial);

  double w_motion() const { return w_motion_; }
  const OwnFrequencies& own() const { return own_; }

 private:
  // A run of a method that only runs tell something of.
  struct Seen {
    double value, error, seconds;
  };

  std::optional<Candidate> from_steps(const Method& method, double error) const;
  std::optional<Candidate> from_seen(const Method& method, double error) const;
  double sensitivity(const Method& method) const;
  double largest_step(const Method& method) const;

  const Stage& stage_;
  OwnFrequencies own_;
  double w_motion_, step_seconds_, sensitivity_;
  std::map<const Method*, double> by_method_;  // error that was seen, over the expected one
  std::map<int, double> by_order_;             // of the last explicit method of that order
  std::map<const Method*, Seen> seen_;
  std::map<const Method*, double> seconds_a_step_;  // as timed [s]
  std::map<const Method*, double> failed_;          // the least step that did not hold [s]
};

}  // namespace qddot::measure
