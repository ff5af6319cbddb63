#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/command/progress.hpp"
#include "qddot/measure/speed/sweep_bound.hpp"

namespace qddot::command {

using namespace measure;

// The progress of sweeps of several methods, one after the other. Borrows the Progress.
class SweepProgress {
 public:
  using Recall = std::function<Point(const Method&, double value, const Effort::Take& take)>;

  // `bound`: of what is left, if nothing follows that takes nobody knows how long; `prefix` stands
  // before what is said.
  SweepProgress(std::vector<const Method*> methods, std::optional<SweepBound> bound,
                std::string prefix = {}, Progress& shown = progress());

  // What Effort::recall is to be, so that each point is said before it is taken; it borrows this.
  Recall seen(Recall recall);
  // A point of the method at hand.
  void take(const Point& point);
  // The method at hand is done.
  void finish();
  // The most that is left [s], if a bound is known.
  std::optional<double> left() const;

 private:
  std::vector<const Method*> methods_;
  std::optional<SweepBound> bound_;
  std::string prefix_;
  Progress& shown_;
  std::size_t at_ = 0;  // methods_
  int points_ = 0;      // of that one
  double seconds_ = 0;  // that the last point took
  double begun_;        // it was then, on the clock of the Progress [s]
};

}  // namespace qddot::command
