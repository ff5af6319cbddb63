#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "qddot/measure/advice/own_frequencies.hpp"
#include "qddot/measure/advice/trial.hpp"

namespace qddot::inline measure {

// A run that can be made, with its expected error and time.
struct Candidate {
  const Method* method = nullptr;
  double value = 0;    // of the knob: h [s] or rtol
  double error = 0;    // expected
  double seconds = 0;  // expected
};

// The power p of the knob to which the error is proportional.
double power_of_error(const Method& method);

// The smallest error that agreement of two runs can prove for a method that splits off stiff
// forces. Its inner steps have an error that finer outer steps do not reduce.
constexpr double least_of_split = 3e-8;

// The approximate time [s] of the method `exact` on the model; infinite if it cannot run it.
double seconds_of_exact(const ReducedScene& model);

// Forecasts the error and the time of runs that were not made:
//   error = sensitivity * frequency_error(method, h w_p),   seconds = steps * seconds of a step,
// where w_p is the motion's own frequency for order p (see OwnFrequencies). The sensitivity is
// where w_p is the motion's own frequency for order p (see OwnFrequencies). The sensitivity starts
// as |q'| t / |q - q(0)|, which is right if errors add up. Each run with a known error corrects the
// sensitivity of its method, of other methods of that order, and of the next orders. Methods that
// choose their steps or split off stiff forces have no forecast before their first run. After it,
// their error is proportional to h^order or to rtol.
class Forecast {
 public:
  // Borrows the stage. `w_motion`: the largest frequency over the motion [rad/s], zero if nothing
  // vibrates. `step_seconds`: the time of one step of Verlet's method [s].
  Forecast(const Stage& stage, const OwnFrequencies& own, double w_motion, double step_seconds);

  // The expected error and time [s] of a run. `value`: the knob, h [s] or rtol. The error is the
  // sum of truncation and of the rounding of all steps; it is infinite if nothing is known.
  double error(const Method& method, double value) const;
  double truncation(const Method& method, double value) const;
  double rounding(const Method& method, double value) const;
  double seconds(const Method& method, double value) const;
  // The factor by which the ratio of two methods' errors may differ from the forecast, one of
  // `doubts`. It is 1 for two runs of one method, 1.5 if errors of both methods were seen, else 4.
  static constexpr std::array doubts = {1.0, 1.5, 4.0};
  double doubt(const Method& one, const Method& other) const;
  // The runs that are expected to reach the error: one for each method, fastest first.
  // `explicit_steps` leaves only explicit methods of fixed steps.
  std::vector<Candidate> candidates(double error, bool explicit_steps = false) const;
  // The same, with an error given for each method.
  std::vector<Candidate> candidates(const std::function<double(const Method&)>& error,
                                    bool explicit_steps = false) const;

  // Replaces the motion's own frequencies by those of a better run, and forgets all errors seen
  // before.
  void learn_frequencies(const OwnFrequencies& own);
  // Whether an error was seen of the method or, if it is explicit, of an explicit method of its
  // order.
  bool has_learned(const Method& method) const;
  // Whether an error was seen of the method itself.
  bool has_seen(const Method& method) const;
  // Corrects the forecast by the error or the time of a run.
  void learn_error(const Trial& trial, double error);
  void learn_seconds(const Trial& trial);
  // Notes that a run of fixed steps failed. Longer steps of the method are then expected to fail
  // too.
  void learn_failure(const Trial& trial);

  double w_motion() const { return w_motion_; }
  const OwnFrequencies& own() const { return own_; }

 private:
  // A run of a method that has no forecast without one.
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
  std::map<const Method*, double> by_method_;  // error seen over error expected
  std::map<int, double> by_order_;             // the same, last explicit method of the order
  std::map<const Method*, Seen> seen_;
  std::map<const Method*, double> seconds_a_step_;  // as timed [s]
  std::map<const Method*, double> failed_;          // the smallest step that failed [s]
};

}  // namespace qddot::inline measure
