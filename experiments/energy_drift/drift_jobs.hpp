#pragma once

#include <vector>

#include "experiments/kit/program.hpp"

namespace qddot::energy_drift {

// The steps of methods of fixed steps, and the length of all runs.
struct Course {
  double step_size, until;  // [s]
};

// The course that was asked for, else half over the largest frequency and a million steps. Throws
// InvalidInput if nothing vibrates or there are more than 1e12 steps.
Course course_of(const Argument<double>& step_size, const Argument<double>& until,
                 const Subject& subject);

// One run to be made.
struct Job {
  const Method* method;
  double value;
  double seconds;  // that it may take
};

// A run of each method of fixed steps, and of each adaptive one at each tolerance. The tolerances
// share the `seconds` of a method.
std::vector<Job> jobs_of(const std::vector<const Method*>& methods, double step_size,
                         const std::vector<double>& rtols, double seconds);

}  // namespace qddot::energy_drift
