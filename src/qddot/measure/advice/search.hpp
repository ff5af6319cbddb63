#pragma once

#include <optional>

#include "qddot/measure/advice/check.hpp"
#include "qddot/measure/advice/forecast.hpp"
#include "qddot/measure/advice/runs.hpp"

namespace qddot::inline measure {

// Searches for the run that reaches an accuracy in the least time, and for a bound of its error.
// A forecast names candidates, runs make trials of them, and a check bounds the trials' errors.
//
//  1. One run becomes the judge: its own error is known to be a small part of the accuracy. Which
//     run that may be depends on the motion:
//       - the motion in closed form, if K is constant and its modes are cheap;
//       - a run with error control, if tolerances that fall by tens give runs that draw together;
//       - the finer of two runs of fixed steps, if a run with error control would take long. The
//         two are chosen by a forecast, which a first run of fixed steps gives.
//  2. The judge is repeated from a start that is one rounding away, of all that was drawn. The
//     distance is the conditioning of the motion. It is a part of each bound.
//  3. Runs that a forecast expects to be faster are made and compared with the judge.
//
// All decisions that lead to a judge or to its refusal count work, so that they are the same on
// every machine at any load. Times choose among runs that are known to be accurate enough.
class Search {
 public:
  // Borrows the model, which must have unknowns and K, and the scene that it is the reduction of,
  // if given. No run begins after `seconds`.
  Search(const Model& model, double until, AccuracyOf of, double seconds,
         const Scene* drawn = nullptr, const Rules& rules = {});

  // Makes runs until the error of one is known to be at most `accuracy`; nullptr if that fails.
  // Then makes runs that may reach the accuracy faster, while that is worth its time.
  const Trial* find(double accuracy);
  // Makes the run unless it was made before.
  void try_once(const Method& method, double value, const Limits& limits);

  const Runs& runs() const { return runs_; }
  const Check& check() const { return check_; }
  // Empty if no forecast was needed.
  const std::optional<Forecast>& forecast() const { return forecast_; }
  // Whether a forecast chose the judge, and not tolerances.
  bool is_judged_by_forecast() const { return is_judged_by_forecast_; }
  // A bound of the largest frequency at the start [rad/s], or its value if a forecast needed it.
  double w_start() const { return w_start_; }

 private:
  // Three runs and the repetition of the finest take about so many times as long as the first.
  static constexpr int runs_of_three = 6;

  // Each finds a judge for the accuracy; false if it does not.
  bool judge(double accuracy);
  bool judge_in_closed_form(double accuracy);
  const Trial& run_if_promising(const Method& method, double rtol, std::int64_t forces);
  bool judge_by_tolerance(const Method& method, double accuracy, std::int64_t& forces_left,
                          bool is_last);
  bool judge_by_error_control(double accuracy, bool implicitly, std::int64_t most_forces,
                              bool is_last);
  bool judge_at_last(double accuracy, bool implicitly);
  bool judge_by_forecast(double accuracy);
  void accept_pair(const Trial& coarse, const Trial& fine, double share);
  bool is_enough(const Trial& run, const Trial& finer, double accuracy);
  bool judge_energy(double accuracy);

  std::vector<const Method*> with_error_control(bool implicitly, double accuracy) const;
  bool may_analyse(double forces) const;
  double forces_of_implicit_step(int order);
  std::int64_t forces_worth_implicit_steps(double accuracy);
  const Trial* survey();
  std::optional<Candidate> explicit_candidate(double error, const Method* checked,
                                              double unseen) const;
  bool may_forecast(const Trial& trial);
  std::optional<Candidate> promised(double error, double seconds, double unseen) const;
  std::optional<Candidate> first_of_method(const Trial& answer, double fewest, double accuracy);
  const Trial* race(const Trial* answer, double accuracy);
  const Trial* race_of_halved_steps(const Trial* answer, double accuracy);

  const Model& model_;
  const System& system_;
  double until_;
  Runs runs_;
  Check check_;
  const Rules& rules_ = runs_.rules();
  std::optional<Forecast> forecast_;
  double w_start_;
  const Trial* finest_ = nullptr;  // of the last runs with error control that gave no judge
  bool is_judged_by_forecast_ = false;
  std::optional<double> implicit_force_;  // explicit ones that take as long
};

}  // namespace qddot::inline measure
