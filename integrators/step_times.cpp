#include "integrators/step_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qddot {

StepTimes::StepTimes(double t_start, double t_stop, double h)
    : t_start_(t_start), t_stop_(t_stop), h_(h) {
  // What the rounding of the two times adds to their distance is no step.
  const double slack = 1e-9 + 4 * std::numeric_limits<double>::epsilon() * std::abs(t_stop) / h;
  count_ = std::max(1.0, std::ceil((t_stop - t_start) / h - slack));
  can_be_taken_ = h > 0 && count_ < 1e15 && t_stop - h != t_stop;
  // Where only rounding parts the last step from h it is h, so that factorisations for h serve it
  // too.
  const double last = t_stop - (t_start + (count_ - 1) * h);
  last_h_ = std::abs(last - h) <= 1e-6 * h ? h : last;
}

}  // namespace qddot
