#pragma once

namespace qddot {

// The times of steps of constant length h from t_start to t_stop [s]: t_start + i h and never a
// running sum, the last one t_stop exactly, after a shorter step where h does not fit.
class StepTimes {
 public:
  StepTimes(double t_start, double t_stop, double h);

  // False where there would be no end: h is not positive, or rounding swallows it, or there are
  // more steps than a double can count.
  bool can_be_taken() const { return can_be_taken_; }
  double count() const { return count_; }
  // The time after step i, and the length of step i = 1 ... count().
  double after(double i) const { return i < count_ ? t_start_ + i * h_ : t_stop_; }
  double length(double i) const { return i < count_ ? h_ : last_h_; }

 private:
  double t_start_, t_stop_, h_, count_, last_h_;
  bool can_be_taken_;
};

}  // namespace qddot
