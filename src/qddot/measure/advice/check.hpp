#pragma once

#include <map>
#include <optional>
#include <vector>

#include "qddot/measure/advice/runs.hpp"

namespace qddot::inline measure {

// An upper bound of a run's error, and the run that gives it; nullptr if no other run is needed.
struct Bound {
  double error = 0;
  const Trial* by = nullptr;
  bool by_coarser = false;  // by a less accurate run of the same method
};

// The effect of rounding on a motion: of starts that are one rounding away.
struct Conditioning {
  double effect = 0;  // on the error that is asked for
  // The part of a bound that rounding takes, as a run rounds in each of its steps.
  double share = 0;
  std::vector<double> differences{};  // at each look
  // The same of a push out of the symmetry of the reductions.
  double leaves_by = 0;
  std::vector<double> differences_left{};

  double worst() const { return leaves_by > effect ? leaves_by : effect; }
};

// Bounds the errors of runs by those of judges: runs whose own errors are known. A run's error is
// at most its distance to a judge, the judge's own error, and the effect of rounding.
class Check {
 public:
  // Borrows the runs.
  explicit Check(Runs& runs) : runs_(runs) {}

  // Takes the run as a judge; the bound is that of its own error, without rounding. Former judges
  // that are farther away than both bounds allow are judges no more.
  void accept(const Trial& judge, const Bound& own);
  bool has_judge() const { return !judges_.empty(); }
  // The judge of least error; nullptr if there is none.
  const Trial* judge() const;
  // The judge's own error.
  double error_of(const Trial& judge) const { return judges_.at(&judge).error; }

  // Repeats a run from starts one rounding away, also out of the symmetry of the reductions. The
  // accuracy says how well the effect must be known. Nothing is known afterwards if a run fails.
  void condition(const Trial& judge, double accuracy);
  // The same by a pair of runs that are `between` apart, as one is pushed: that is at least the
  // effect. If a run that is known is not so beside it, the first run of the motion is repeated.
  void condition_by_pair(const Trial& known, double between, const Trial& first, double accuracy);
  // Repeats it out of the symmetry alone. False if that fails, and nothing is known afterwards.
  bool condition_symmetry(const Trial& judge, double accuracy);
  void set(const std::optional<Conditioning>& conditioning) { conditioning_ = conditioning; }
  // The effect of rounding; empty if no run that resolves the motion was repeated.
  const std::optional<Conditioning>& conditioning() const { return conditioning_; }
  // Whether rounding alone makes the accuracy impossible.
  bool is_hopeless(double accuracy) const {
    return conditioning_ && conditioning_->worst() > accuracy;
  }

  // A bound of the trial's error; empty if none is known.
  std::optional<Bound> bound(const Trial& trial) const;
  // Whether the trial may be an answer and its bound is at most the accuracy.
  bool is_known(const Trial& trial, double accuracy) const;
  // The trial of least bound, and the fastest whose bound is at most the accuracy; nullptr if there
  // is none.
  const Trial* best() const;
  const Trial* fastest(double accuracy) const;

 private:
  void condition_rest(const Trial& judge);
  double between_steps(const Trial& trial) const;
  double beyond_own_error(const Trial& trial, double apart_by) const;
  double by_chance(const Trial& judge, double apart) const;

  Runs& runs_;
  std::optional<Conditioning> conditioning_;
  std::map<const Trial*, Bound> judges_;
};

}  // namespace qddot::inline measure
