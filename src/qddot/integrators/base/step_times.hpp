#pragma once

namespace qddot {

// The most steps: after more of one length, times are no longer distinct in double precision.
constexpr double most_steps = 1e15;

// The times of steps of constant length h from t_start to t_end [s]: t_start + i h, never a running
// sum. The last step ends on t_end exactly. It is shorter if h does not fit, and longer or shorter
// by up to 1e-6 h if it almost does.
class StepTimes {
 public:
  StepTimes(double t_start, double t_end, double h);

  // False if the steps would not end: h is not positive, rounding swallows it, or there are more
  // steps than a double can count.
  bool can_be_taken() const { return can_be_taken_; }
  double count() const { return count_; }
  // The time after step i, and the length of step i = 1 ... count().
  double after(double i) const { return i < count_ ? t_start_ + i * h_ : t_end_; }
  double length(double i) const { return i < count_ ? h_ : last_h_; }
  // The last step that ends at t or before, but for rounding, and whether step i ends just there.
  double last_by(double t) const;
  bool is_after(double i, double t) const { return reaches(i, t) && t <= after(i) + rounding_; }

 private:
  bool reaches(double i, double t) const { return t >= after(i) - rounding_; }

  double t_start_, t_end_, h_, count_, last_h_, rounding_;
  bool can_be_taken_;
};

}  // namespace qddot
