#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "qddot/measure/trend/energy_trend.hpp"

namespace qddot::inline measure {

// An error of a known kind as a function of time over a run from 0 to 1. Each seed draws another
// one. It is called with ascending times.
using ErrorCourse = std::function<double(double t)>;

// A kind of errors, and its true properties.
struct SyntheticKind {
  std::string name;
  std::function<ErrorCourse(std::mt19937_64&)> draw;
  std::vector<Verdict> right;  // right verdicts; `undecided` and `unknown` claim nothing
  // True values over the whole run. `drift`: the slope of a line, zero for errors that return or
  // walk. `rate`: the rate of an exponential. `widening`: the growth of an oscillation over its
  // mean size.
  std::optional<double> drift{}, rate{}, widening{};
  std::optional<double> period{}, memory{};  // of a slow sine; of coloured noise
  std::optional<double> walk{};              // standard deviation that a walk gains over the run
  double rounding = 0;                       // one rounding of the energy
};

// All kinds: errors that stay, wander, drift, end, grow and decay. They are about 1e-4, for an
// excess energy of 1, with noise or with fast oscillations that samples do not resolve.
std::vector<SyntheticKind> synthetic_kinds();

// The trend of one run of a kind, of a million steps and 1000 s, sampled as in energy_drift
// (sample_steps.hpp).
constexpr double synthetic_steps = 1e6, synthetic_duration = 1000;
Trend synthetic_trend(const SyntheticKind& kind, std::uint64_t seed, int cells);

}  // namespace qddot::inline measure
