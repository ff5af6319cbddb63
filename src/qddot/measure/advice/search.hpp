#pragma once

#include <chrono>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "qddot/measure/advice/forecast.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::inline measure {

// An upper bound of a run's error, and the run that gives it; nullptr if no other run is needed.
struct Bound {
  double error = 0;
  const Trial* by = nullptr;
  bool by_coarser = false;  // by a less accurate run of the same method
};

// Searches for the run that reaches an accuracy in the least time, and for a bound of its error.
//
//  1. The first run is one of Verlet's method near its stability limit. Short bursts start from its
//     states. They give the motion's own frequencies, the change of w_max and the time of a force.
//     There is no search if K is constant and all modes are found in less time than that.
//  2. A Forecast names the run that reaches half of the accuracy in the least time. That run is
//     made, unless an earlier run is expected to be good enough.
//  3. Another run checks it. If errors are small and time matters, the check is a coarser run of
//     the same method, since such errors fall as the order says. Else the check is a run with less
//     than half the expected error. The distance of the two is the error of the first, up to the
//     error of the second; with two runs of one method that error is within the distance too. If
//     the first error is expected to be far below the accuracy, a slightly finer run is enough.
//     Every run corrects the forecast. If no bound is within the accuracy, step 2 follows again.
// Some methods need not resolve stiff springs. One of them is tried first if stiff springs are
// named. So it is if the first run would take a thousand times as long as a few implicit steps. It
// is refined until its runs agree, for a small part of the first run's time; then it is given up.
// Verlet's method cannot step systems with massless nodes: IDA is refined there.
class Search {
 public:
  // Borrows the model, which must have unknowns and K. No run begins after `seconds`.
  Search(const ReducedScene& model, double until, AccuracyOf of, double seconds);

  // Makes the first run and its bursts, for an accuracy that find() will be asked for. Returns
  // false if the run did not reach the end; trials() says why.
  bool survey(double accuracy);
  // Makes runs until the error of one is known to be at most `accuracy`; nullptr if that fails.
  const Trial* find(double accuracy);
  // Makes runs that may reach the accuracy faster than `answer`, while that is worth its time and
  // for `seconds` at most. Returns the fastest run that is known to reach it.
  const Trial* race(const Trial* answer, double accuracy, double seconds);

  // A run with more steps of an implicit method that missed the accuracy or diverged. It has the
  // number of steps that the order predicts, or one step if the method was not tried. Empty if that
  // takes `seconds` or more. Needs a forecast.
  std::optional<Candidate> more_steps(const Method& method, double accuracy, double seconds) const;
  // Tries explicit runs that are expected to be too coarse, the least coarse first. Errors change
  // sign, so that one of them may be accurate by chance. Each is compared with checked runs and
  // does not correct the forecast. Returns the fastest run that is known to reach the accuracy.
  const Trial* gamble(const Trial* answer, double accuracy, double seconds);
  // Makes the run unless it was made before, for `seconds` at most.
  void try_once(const Candidate& candidate, double seconds);

  // A bound of the trial's error from its distance to more accurate trials, else to a coarser one.
  // Empty if there is neither.
  std::optional<Bound> bound(const Trial& trial) const;
  // Whether the trial's error bound is at most the accuracy.
  bool is_known(const Trial& trial, double accuracy) const;
  // The bound of the trial's error, or the expected error if there is none.
  double error(const Trial& trial) const;
  // The most accurate trial that can check this one; nullptr if there is none.
  const Trial* checker(const Trial& trial) const;
  // The coarser trial of the same method that bounds the error if no trial checks it, or nullptr.
  // If errors fall by the method's order, the error of the finer run is less than the distance of
  // the two.
  const Trial* coarser(const Trial& trial) const;
  // The trial with the least expected error, or nullptr if none reached the end. `seen_on_its_way`
  // leaves only trials that were also seen before the end; `longest` limits their time [s].
  const Trial* most_accurate(bool seen_on_its_way = false,
                             double longest = std::numeric_limits<double>::infinity()) const;

  // Takes the scales of errors from the trial (see Stage).
  void measure_by(const Trial& trial);
  // The distance of two trials that reached the end (see Stage); computed once.
  double distance(const Trial& one, const Trial& other) const;

  const Stage& stage() const { return stage_; }
  // Set by survey(); empty if no forecast was needed.
  const std::optional<Forecast>& forecast() const { return forecast_; }
  const std::deque<Trial>& trials() const { return trials_; }
  double w_start() const { return w_start_; }
  double seconds_left() const;
  // The time [s] after which more runs hardly help: finer steps remove neither chaos nor rounding.
  double seconds_worth_trying() const;
  // No run begins after `seconds` from the start.
  void stop_after(double seconds) { limit_ = seconds; }

 private:
  // An earlier run is good enough if its expected error is at most this fraction of the accuracy.
  static constexpr double good_enough = 0.6;
  // A run checks another one if its expected error is smaller by at least this factor.
  static constexpr double checks = 2.1;
  // Two runs at this distance or more tell nothing about each other.
  static constexpr double lost = 0.1;
  // Steps of the first run of an implicit method; a coarse accuracy may need only some steps.
  static double few_steps(double accuracy) { return accuracy > 1e-3 ? 2 : 8; }
  // Steps of a run of Verlet's method at its stability limit, from the bound of w_max at the start;
  // at least 1.
  double steps_of_verlet() const;

  // Implicit methods are not used for an accuracy of the energy: steps that are too long hardly
  // move, which conserves it.
  bool may_be_implicit() const { return of_ != AccuracyOf::energy; }
  std::optional<Bound> bound_by_order(const Trial& trial) const;
  std::optional<Bound> bound_by_checked(const Trial& best) const;
  double expected(const Trial& trial) const;
  bool is_vague(const Trial& trial) const;
  double rounding(const Trial& trial) const;
  double truncation(const Trial& trial) const;
  double ratio(const Trial& other, const Trial& trial) const;
  bool is_check(const Trial& other, const Trial& trial) const;
  double likely_distance(const Trial& trial, const Trial& better) const;
  bool is_refined_by(const Trial& coarser, const Trial& finer) const;
  bool is_hardly_finer(const Trial& finer, const Trial& trial) const;
  bool falls_by_order(const Trial& finer, double error_of_coarser) const;
  double bound_by_coarser(const Trial& trial, const Trial& coarser) const;
  double bound_by_hardly_finer(const Trial& trial, const Trial& finer) const;
  double lost_distance(const Trial& trial, const Trial& better) const;
  bool all_are_lost() const;
  bool was_tried(const Candidate& candidate) const;
  std::optional<Candidate> coarser_check_of(const Trial& trial, double accuracy) const;
  std::optional<Candidate> check_of(const Trial& trial, double accuracy) const;
  std::optional<Candidate> fresh(double accuracy) const;
  std::optional<Candidate> unknown(const Trial& answer, double accuracy, double left) const;
  std::optional<Candidate> promised(double accuracy, double seconds, bool explicitly) const;
  std::optional<Candidate> unseen(double accuracy, double seconds) const;
  std::optional<Candidate> lead(double accuracy, double seconds) const;
  bool survey_by_verlet();
  void survey_again();
  const Trial* by_tolerance(double accuracy);
  bool refine(const Method& method, double steps, double accuracy, double seconds, double longest);
  bool by_refinement(double accuracy);
  Trial& run(const Method& method, double value, double seconds);
  void learn();

  AccuracyOf of_;
  double limit_;
  std::chrono::steady_clock::time_point begin_ = clock_now();
  double bound_of_w_, w_start_ = 0, first_seconds_ = 0;
  Stage stage_;
  std::optional<Forecast> forecast_;
  std::deque<Trial> trials_;
  mutable std::map<std::pair<const Trial*, const Trial*>, double> distances_;  // by these scales
  mutable std::map<const Trial*, double> truncations_;  // by the present forecast
  const Trial* surveyed_by_ = nullptr;                  // the run at whose states bursts began
  const Trial* measured_by_ = nullptr;  // the run that gave the scales; its expected error:
  double measured_within_ = std::numeric_limits<double>::infinity();
};

}  // namespace qddot::inline measure
