#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/kit/progress.hpp"
#include "qddot/measure/speed/sweep_bound.hpp"

namespace qddot::inline kit {

// The progress of sweeps of several methods, one after the other. Borrows the Progress.
class SweepProgress {
 public:
  using Recall = std::function<Point(const Method&, double value, const Effort::Take& take)>;

  // `bound`: of the remaining time, if no work of unknown length follows. `prefix`: put before each
  // text.
  SweepProgress(std::vector<const Method*> methods, std::optional<SweepBound> bound,
                std::string prefix = {}, Progress& shown = progress());

  // A function for Effort::recall that reports each point before it is measured. It borrows this
  // object.
  Recall seen(Recall recall);
  // Counts a point of the present method.
  void take(const Point& point);
  // Ends the present method.
  void finish();
  // An upper bound of the remaining time [s], if known.
  std::optional<double> left() const;

 private:
  std::vector<const Method*> methods_;
  std::optional<SweepBound> bound_;
  std::string prefix_;
  Progress& shown_;
  std::size_t at_ = 0;  // methods_
  int points_ = 0;      // of that one
  double seconds_ = 0;  // time of the last point
  double begun_;        // start of the point, on the Progress's clock [s]
};

}  // namespace qddot::inline kit
