#pragma once

#include <array>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/study.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::stability_map {

// The tolerances at which adaptive methods are tried.
inline constexpr std::array tolerances = {1e-2, 1e-4, 1e-6};

// So many numbers from `low` to `high`, in equal ratios.
std::vector<double> spaced(double low, double high, int count);

// The largest h w at which no vibration grows.
struct Limit {
  const Method* method;
  double predicted, measured;  // of h w; infinite without a limit

  // The relative difference of the measured limit from the predicted one, if there is one.
  double difference() const { return (measured - predicted) / predicted; }
};

// Adds the limits of the methods that have a linear step to `limits`. Each is a piece of the study.
void add_limits(Study& study, const std::vector<const Method*>& methods,
                std::vector<Limit>& limits);
// Writes limits.csv; `omega_max` [rad/s]: w_max of the scene at its start.
void tabulate(Csv& csv, const std::vector<Limit>& limits, double omega_max);
void print(const std::vector<Limit>& limits);

// Writes damped_limits.csv: the largest h w at which no vibration of a damping ratio from 0.01 to
// 10 grows, of each method that takes dashpots. The rows of a method are a piece of the study.
void tabulate_damped_limits(Study& study, Csv& csv, const std::vector<const Method*>& methods);

// Writes linear.csv: the spectral radius, damping ratio and period error of each linear step.
void tabulate_linear(Csv& csv, const std::vector<const Method*>& methods);
// Writes adaptive.csv: the steps that adaptive methods choose. The row of each method, tolerance
// and frequency is a piece of the study.
void tabulate_adaptive(Study& study, Csv& csv, const std::vector<const Method*>& methods);

// Writes modal.csv: a row for each method that has a step of its own and each of a dozen natural
// modes of the scene at rest. A row has the damping ratio, period error and spectral radius,
// predicted on an oscillator of the same physical damping ratio and measured by exciting the mode,
// and the verdict. What exceeds the physical damping ratio is the method's own. If a method fails
// to make the steps, the reason replaces the verdict. h = `step_size` [s], or 1/w_max if that is 0.
// Runs on all cores (OpenMP); the rows of a method are a piece of the study.
void tabulate_modes(Study& study, Csv& csv, const std::vector<const Method*>& methods,
                    const Model& rest, double step_size);

}  // namespace qddot::stability_map
