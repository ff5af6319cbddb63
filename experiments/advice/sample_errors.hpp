#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/advice/hard_case.hpp"
#include "experiments/kit/csv.hpp"

namespace qddot::judged_advice {

// A run of a hard case that is looked at between its steps. Its errors are those of positions,
// relative.
struct SampledRun {
  std::string name{}, kind{}, method{};
  double value = 0;  // of the knob
  bool reached_end = false;
  // The largest at a look, that of the end, and the largest at ends of steps.
  double sample_error = 0, end_error = 0, error_at_steps = 0;
  // The largest error of a look over the largest of three numbers: the error at the end, that at
  // ends of steps so far, and the tolerance of a position. The plain one is over the error at the
  // end and rtol.
  double ratio = 0, plain_ratio = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SampledRun, name, kind, method, value, reached_end, sample_error,
                                   end_error, error_at_steps, ratio, plain_ratio)

struct SampledCase {
  std::string name{}, left_out{};  // the reason why no run is measured, or nothing
  double conditioning = 0;
  std::vector<SampledRun> runs{};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SampledCase, name, left_out, conditioning, runs)

// Runs all methods with error control at several tolerances and measures their looks against the
// true motion. Tolerances near its conditioning are left out.
SampledCase sampled_case(const HardCase& hard);

// The columns of samples.csv.
const Columns<SampledRun>& sample_columns();

// The ratios of all runs of a method that reach their end.
struct SampledMethod {
  std::string method{};
  double runs = 0, ended_early = 0;
  // The share is the percentage of ratios above 20.
  double largest = 0, median = 0, share = 0, plain_largest = 0, plain_median = 0, plain_share = 0;
};
// Sums up the runs by method, in the order of the registry.
std::vector<SampledMethod> by_method(const std::vector<SampledCase>& cases);

}  // namespace qddot::judged_advice
