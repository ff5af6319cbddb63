#pragma once

#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "qddot/measure/advice/check.hpp"
#include "qddot/measure/advice/own_frequencies.hpp"

namespace qddot::inline measure {

// A run that can be made, with its expected error and time.
struct Candidate {
  const Method* method = nullptr;
  double value = 0;    // of the knob: h [s] or rtol
  double error = 0;    // expected
  double seconds = 0;  // expected
  double forces = 0;   // expected evaluations of f
};

// The power p of the knob to which the error is proportional.
double power_of_error(const Method& method);

// Forecasts the error and the time of runs that were not made. The error of an explicit method of
// fixed steps is
//   sensitivity * frequency_error(method, h w_p),
// where w_p is the motion's own frequency for order p (see OwnFrequencies). The sensitivity starts
// as |q'| t / |q - q(0)|, which is right if errors add up. Each run with a known error corrects the
// sensitivity of its method, and that of other methods by a part. Other methods have no forecast
// before their first run. After it, their error is proportional to h^order or to rtol. The time is
// the number of steps times the time of a step. A method that was not seen takes as long for each
// force as the fastest one that was.
class Forecast {
 public:
  // Borrows the runs. `path` is the motion as one of them saw it, `w_motion` the largest frequency
  // over it [rad/s], which is above zero.
  Forecast(const Runs& runs, const std::vector<State>& path, double w_motion);

  // The expected error; infinite if nothing is known. `value`: the knob, h [s] or rtol.
  double error(const Method& method, double value) const;
  // The factor by which the ratio of two methods' errors may differ from the forecast.
  double doubt(const Method& one, const Method& other) const;
  // The run of the method that is expected to have the error; empty if there is none.
  std::optional<Candidate> candidate(const Method& method, double error) const;
  // The step size [s] at which the error of a method of fixed steps is expected by its frequency
  // error alone, as if it resolved all vibrations.
  double step_by_frequency(const Method& method, double error) const;
  // Those runs of all methods that fit the system, fastest first.
  std::vector<Candidate> candidates(double error) const;

  // Whether an error of the method was seen.
  bool has_seen(const Method& method) const { return seen_.contains(&method); }
  // Corrects the forecast by the runs: by the errors that the check knows, and else by distances to
  // the run that is expected to be the most accurate.
  void learn(const Check& check);
  // Corrects the forecast by the error and the time of a run.
  void learn(const Trial& trial, double error);

  double w_motion() const { return w_motion_; }
  const OwnFrequencies& own() const { return own_; }

 private:
  struct Seen {
    double value, error, seconds, forces;
  };

  double by_frequency(const Method& method, double value) const;
  double correction(const Method& method) const;
  double scale(const Method& method) const;
  double largest_step(const Method& method) const;
  double steps_over(const Method& method, double value, const Seen& seen) const;
  double forces(const Method& method, double value) const;
  double seconds(const Method& method, double value) const;

  double error_seen(const Trial& trial, const Trial& by) const;

  const Runs& runs_;
  const Rules& rules_;
  OwnFrequencies own_;
  double w_motion_, force_seconds_, sensitivity_, until_;
  double seconds_a_force_ = std::numeric_limits<double>::infinity();  // of the runs that were seen
  std::map<const Method*, Seen> seen_;
  std::map<int, double> by_order_;          // error seen over error expected, of the last run
  std::map<const Method*, double> failed_;  // the smallest step that failed [s]
};

// Whether the forecast of the method needs no run: an explicit method of fixed steps.
bool is_forecast_by_frequency(const Method& method);

}  // namespace qddot::inline measure
