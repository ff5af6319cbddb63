#include "qddot/integrators/base/step_times.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

// If the rest of the time is a smaller part of h, the last step is longer by it instead.
constexpr double sliver = 1e-6;

}  // namespace

StepTimes::StepTimes(double t_start, double t_end, double h)
    : t_start_(t_start), t_end_(t_end), h_(h) {
  // The rounding error of a multiple of h, or of a time between samples.
  rounding_ = 4 * machine_epsilon * std::max(std::abs(t_start), std::abs(t_end));
  count_ = std::max(1.0, std::ceil((t_end - t_start) / h - sliver - rounding_ / h));
  can_be_taken_ = h > 0 && count_ < most_steps && t_end - h != t_end;
  // If the last step differs from h by rounding only, it is h, so that factors for h can be used.
  const double last = t_end - (t_start + (count_ - 1) * h);
  last_h_ = std::abs(last - h) <= rounding_ ? h : last;
  rounding_ = std::min(rounding_, h / 4);
}

double StepTimes::last_by(double t) const {
  double i = std::clamp(std::floor((t - t_start_) / h_), 0.0, count_);
  while (i > 0 && !reaches(i, t)) --i;
  while (i < count_ && reaches(i + 1, t)) ++i;
  return i;
}

}  // namespace qddot
