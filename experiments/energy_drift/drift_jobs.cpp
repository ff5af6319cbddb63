#include "experiments/energy_drift/drift_jobs.hpp"

#include <cmath>

#include <fmt/format.h>

#include "qddot/measure/trend/drift_run.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::energy_drift {
namespace {

constexpr double standard_resolution = 0.5;  // h w_max
constexpr double standard_steps = 1e6, most_steps = 1e12;

}  // namespace

Course course_of(const Argument<double>& step_size, const Argument<double>& until,
                 const Subject& subject) {
  Course course{step_size, until};
  if (!step_size.is_given()) {
    course.step_size = standard_resolution / fastest_frequency(subject.model);
    if (!std::isfinite(course.step_size)) {
      throw InvalidInput(
          fmt::format("--step-size is missing, and nothing in {} vibrates that could give a "
                      "default; it is h in s, greater than 0",
                      subject.source));
    }
  }
  if (!until.is_given()) course.until = standard_steps * course.step_size;
  const double steps = course.until / course.step_size;
  if (!(steps >= 1 && steps <= most_steps)) {
    throw InvalidInput(
        fmt::format("--until {}: that is {:.3g} steps of {} s; allowed are 1 to {:.0e}",
                    course.until, steps, course.step_size, most_steps));
  }
  return course;
}

std::vector<Job> jobs_of(const std::vector<const Method*>& methods, double step_size,
                         const std::vector<double>& rtols, double seconds) {
  std::vector<Job> jobs;
  for (const Method* method : methods) {
    if (method->knob == Knob::step_size) {
      jobs.push_back({method, step_size, seconds});
    } else {
      const double share = seconds / static_cast<double>(rtols.size());
      for (const double rtol : rtols) jobs.push_back({method, rtol, share});
    }
  }
  return jobs;
}

}  // namespace qddot::energy_drift
