#pragma once

#include <chrono>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "qddot/measure/advice/forecast.hpp"

namespace qddot::measure {

// What the error of a run is at most, and the run that says so; nullptr where none has to.
struct Bound {
  double error = 0;
  const Trial* by = nullptr;
  bool by_coarser = false;  // a run of the same method that is less accurate
};

// Looks for the run that comes to an accuracy in the least time, and for a bound of its error.
//
//  1. A first run by Verlet's method near its limit, seen on its way, and short bursts from there
//     say what the motion's own frequencies are, how w_max changes, and what a force takes. Where K
//     is constant and all modes are found sooner than that, there is nothing to search.
//  2. A Forecast names the run that comes to half of the accuracy in the least time. It is made,
//     unless one that was made already is expected to be good enough.
//  3. Another checks it. Where errors are small and time matters, this is a coarser run of the same
//     method, as such errors fall as the order says. Else it is one that is expected to miss by
//     less than half of that: their distance is the error of the first but for that of the second,
//     which is itself within it where both are of one method. Where that is expected to be far
//     within the accuracy, a run that is hardly finer will do. All runs teach the forecast. Where
//     no bound is within the accuracy, 2. again, from what is known now.
// Where the first run would take a thousand times what a few implicit steps do, or stiff springs
// are named, a method that need not resolve them is refined before, until its runs agree: in a
// small part of the first run's time, or it is left. Systems with massless nodes have no Verlet
// steps: IDA is refined.
class Search {
 public:
  // Borrows the model, which must have unknowns and K. `seconds`: after which nothing more is
  // begun.
  Search(const ReducedScene& model, double until, AccuracyOf of, double seconds);

  // The first run and what it tells, for an accuracy that find() is going to be asked for. False
  // where it did not come to the end; trials() says why.
  bool survey(double accuracy);
  // Refines until a run is known to be within `accuracy`; nullptr where none came there.
  const Trial* find(double accuracy);
  // Makes runs that may be faster than `answer` to the accuracy, for as long as that is worth and
  // so many seconds at most; returns the fastest one that is known to be so accurate.
  const Trial* race(const Trial* answer, double accuracy, double seconds);

  // Makes that run, unless it was made, for so many seconds at most.
  void try_once(const Candidate& candidate, double seconds);

  // A bound of the trial's error, from how far it is from those that are more accurate or else from
  // a coarser one; nothing where there is none of these.
  std::optional<Bound> bound(const Trial& trial) const;
  bool is_known(const Trial& trial, double accuracy) const;  // to be within the accuracy
  // What is known of the trial's error, or else expected.
  double error(const Trial& trial) const;
  // The most accurate of the trials that bound the error of this one; nullptr where there is none.
  const Trial* checker(const Trial& trial) const;
  // The coarser trial of the same method that bounds it else: an order that shows leaves the finer
  // of two runs within their distance. nullptr where there is none.
  const Trial* coarser(const Trial& trial) const;
  // The trial that is expected to be the most accurate, of all or of those that were seen on their
  // way, in at most so many seconds; nullptr where none came to the end.
  const Trial* most_accurate(bool seen_on_its_way = false,
                             double longest = std::numeric_limits<double>::infinity()) const;

  // Measures the motion by that trial (see Stage).
  void measure_by(const Trial& trial);
  // How far two of trials() that came to the end are apart (see Stage), compared once.
  double distance(const Trial& one, const Trial& other) const;

  const Stage& stage() const { return stage_; }
  // After survey(); nothing where all was clear without.
  const std::optional<Forecast>& forecast() const { return forecast_; }
  const std::deque<Trial>& trials() const { return trials_; }
  double w_start() const { return w_start_; }
  double seconds_left() const;
  // After so many seconds without an answer, more hardly helps: chaos and rounding are not refined
  // away.
  double seconds_worth_trying() const;
  // Begins nothing more after so many seconds in all.
  void stop_after(double seconds) { limit_ = seconds; }

 private:
  // Fraction of an accuracy that an earlier run may be expected to miss by and be taken for good
  // enough.
  static constexpr double good_enough = 0.6;
  // How many times as accurate a run must be to check another.
  static constexpr double checks = 2.1;
  // Two runs that are so far apart have nothing to do with each other.
  static constexpr double lost = 0.1;
  // Steps that implicit methods begin with: what is not to be accurate may be a motion of some
  // steps.
  static double few_steps(double accuracy) { return accuracy > 1e-3 ? 2 : 8; }
  // Steps that a run of Verlet's method takes at its limit, by the bound of w_max at the start; at
  // least 1.
  double steps_of_verlet() const;

  // Nothing keeps its energy better than what hardly moves, as too long implicit steps may.
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
  std::optional<Candidate> more_steps(const Method& method, double accuracy, double seconds) const;
  std::optional<Candidate> unknown(const Trial& answer, double accuracy, double left) const;
  std::optional<Candidate> promised(double accuracy, double seconds, bool explicitly) const;
  std::optional<Candidate> unseen(double accuracy, double seconds) const;
  const Trial* gamble(const Trial* answer, double accuracy, double seconds);
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
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double bound_of_w_, w_start_ = 0, first_seconds_ = 0;
  Stage stage_;
  std::optional<Forecast> forecast_;
  std::deque<Trial> trials_;
  mutable std::map<std::pair<const Trial*, const Trial*>, double> distances_;  // as measured now
  mutable std::map<const Trial*, double> truncations_;  // as the forecast has them now
  const Trial* surveyed_by_ = nullptr;                  // the run that bursts went along
  const Trial* measured_by_ = nullptr;  // the motion, by a run that is expected to miss by
  double measured_within_ = std::numeric_limits<double>::infinity();
};

}  // namespace qddot::measure
