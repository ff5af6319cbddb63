#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/points.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::stock_sundials {

// An implicit method of SUNDIALS with n x n solves, and as its users run it.
struct Pair {
  const Method* structured;
  const Method* stock;
};

// The runs of one of the two.
struct Way {
  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

  Outcome outcome{};
  double seconds = nothing;  // the median of the timed runs
  double error = nothing;    // of the positions at the end
  Counts counts{};
  // Parts of a run's time: force, K, factorisation, solves, and the rest.
  std::array<double, 5> shares{nothing, nothing, nothing, nothing, nothing};
};

// The two at one tolerance; numbers are missing unless both reached the end.
struct PairedRuns {
  std::string scene, method;
  double rtol = 0;
  Way structured{}, stock{};
  double ratio = Way::nothing;  // the median of stock over structured times

  bool is_good() const {
    return structured.outcome == Outcome::reached_end && stock.outcome == Outcome::reached_end;
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Way, outcome, seconds, error, counts, shares)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PairedRuns, scene, method, rtol, structured, stock, ratio)

// The methods of that name with their stock ways, or all that can run the scene. Throws
// InvalidInput for a method without one.
std::vector<Pair> select_pairs(const std::vector<std::string>& names, const Subject& subject);

// Runs both by turns, once untimed and then `effort.repeats` times, and once more by the clocks of
// their parts.
PairedRuns paired_runs(const Subject& subject, const Pair& pair, double rtol,
                       const Reference& reference, const Effort& effort);

}  // namespace qddot::stock_sundials
