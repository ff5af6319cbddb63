#pragma once

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

// The effect of rounding on a motion: of a start that is one rounding away.
struct Conditioning {
  double effect = 0;                  // on the error that is asked for
  std::vector<double> differences{};  // at each look
  // The same of a push out of the symmetry of the reductions.
  double leaves_by = 0;
  std::vector<double> differences_left{};
};

// Searches for the run that reaches an accuracy in the least time, and for a bound of its error.
//
//  1. One run becomes the judge: its own error is known to be a small part of the accuracy. Which
//     run that may be depends on the motion:
//       - the motion in closed form, if K is constant and its modes are cheap;
//       - a run with error control, if tolerances that fall by tens give runs that draw together;
//       - the finer of two runs of fixed steps, if a run with error control would take long. The
//         two are chosen by a forecast, which a run of Verlet's method gives.
//  2. The judge is repeated from a start that is one rounding away, of all that was drawn. The
//     distance is the conditioning of the motion. It is a part of each bound.
//  3. Runs that a forecast expects to be faster are made and compared with the judge.
//
// All decisions that lead to a judge or to its refusal count work, so that they are the same on
// every machine at any load; with one exception. An implicit judge is tried first if its first
// steps take little time beside those of Verlet's method. Times also choose among runs that are
// known to be accurate enough.
class Search {
 public:
  // Borrows the model, which must have unknowns and K, and the scene that it is the reduction of,
  // if given. No run begins after `seconds`.
  Search(const ReducedScene& model, double until, AccuracyOf of, double seconds,
         const Scene* drawn = nullptr);

  // Makes runs until the error of one is known to be at most `accuracy`; nullptr if that fails.
  // Then makes runs that may reach the accuracy faster, while that is worth its time.
  const Trial* find(double accuracy);
  // Makes the run unless it was made before, for `seconds` at most.
  void try_once(const Method& method, double value, double seconds);

  // A bound of the trial's error; empty if none is known.
  std::optional<Bound> bound(const Trial& trial) const;
  // Whether the trial may be an answer and its bound is at most the accuracy.
  bool is_known(const Trial& trial, double accuracy) const;
  // The trial of least bound; nullptr if no trial has one.
  const Trial* best() const;
  // The effect of one rounding; empty if no run that resolves the motion was repeated.
  const std::optional<Conditioning>& conditioning() const { return conditioning_; }

  // Whether a forecast chose the judge, and not tolerances.
  bool is_judged_by_forecast() const { return is_judged_by_forecast_; }

  const Stage& stage() const { return stage_; }
  // Empty if no forecast was needed.
  const std::optional<Forecast>& forecast() const { return forecast_; }
  const std::deque<Trial>& trials() const { return trials_; }
  double w_start() const { return w_start_; }
  double seconds_left() const;

 private:
  // The bound of a judge by itself.
  struct Judged {
    double error;
    const Trial* by;
    bool by_coarser;
  };

  bool judge(double accuracy);
  bool judge_in_closed_form(double accuracy);
  bool judge_by_tolerance(const Method& method, double accuracy, std::int64_t& forces_left);
  std::vector<const Method*> with_error_control(bool implicitly, double accuracy) const;
  bool judge_by_error_control(double accuracy, bool implicitly, std::int64_t most_forces);
  std::int64_t forces_worth_implicit_steps(double accuracy);
  bool judge_by_forecast(double accuracy);
  bool judge_energy(double accuracy);
  void condition(const Trial& judge);
  void condition_symmetry(const Trial& judge);
  double beyond_own_error(const Trial& trial, double apart_by) const;
  // Whether rounding alone makes the accuracy impossible.
  bool is_hopeless(double accuracy) const {
    return conditioning_ && std::max(conditioning_->effect, conditioning_->leaves_by) > accuracy;
  }

  const Trial* survey();
  void begin_forecast(const std::vector<State>& path, double w);
  bool may_forecast(const Trial& trial);
  void learn();
  std::optional<Candidate> promised(double error, double seconds) const;
  std::optional<Candidate> untried(const Trial& answer, double accuracy) const;
  const Trial* fastest(double accuracy) const;
  const Trial* race(const Trial* answer, double accuracy);

  Trial& run(const Method& method, double value, const Limits& limits, bool is_pushed = false);
  void measure_by(const Trial& trial);
  double distance(const Trial& one, const Trial& other) const;
  double distance_on_the_way(const Trial& one, const Trial& other) const;
  bool was_tried(const Method& method, double value) const;
  double steps_of_verlet() const;
  std::int64_t forces_within(double work) const;

  double limit_;
  std::chrono::steady_clock::time_point begin_ = clock_now();
  double bound_of_w_, w_start_ = 0;
  Stage stage_;
  std::optional<Forecast> forecast_;
  std::optional<Conditioning> conditioning_;
  std::deque<Trial> trials_;
  std::map<const Trial*, Judged> judges_;
  mutable std::map<std::pair<const Trial*, const Trial*>, double> distances_;  // by these scales
  const Trial* finest_ = nullptr;  // of the last runs with error control that gave no judge
  bool rests_ = false, is_judged_by_forecast_ = false;
};

}  // namespace qddot::inline measure
