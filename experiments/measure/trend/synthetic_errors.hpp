#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "qddot/measure/trend/energy_trend.hpp"

namespace qddot::measure {

// What errors of a known kind do, over a run from 0 to 1: drawn anew for each seed, called with
// times that ascend.
using ErrorCourse = std::function<double(double t)>;

// A kind of errors, and what is true of it.
struct SyntheticKind {
  std::string name;
  std::function<ErrorCourse(std::mt19937_64&)> draw;
  std::vector<Verdict> right;  // verdicts that are right; `undecided` and `unknown` claim nothing
  // Over the whole run: of a line the slope, of what comes back or walks zero; of what falls or
  // rises exponentially its rate; the growth of an oscillation over its mean size.
  std::optional<double> drift{}, rate{}, widening{};
  std::optional<double> period{}, memory{};  // of a slow sine, and of coloured noise
  std::optional<double> walk{};              // standard deviation that a walk gains over the run
  double rounding = 0;                       // what one rounding of the energy is
};

// Errors that stay, wander, drift, end, grow and decay, of 1e-4 and thereabouts over an excess
// energy of 1, with noise or fast oscillations that samples do not resolve.
std::vector<SyntheticKind> synthetic_kinds();

// One run of a kind as energy_drift would see it (sample_steps.hpp), lasting a million steps and
// 1000 s, and its trend.
constexpr double synthetic_steps = 1e6, synthetic_duration = 1000;
Trend synthetic_trend(const SyntheticKind& kind, std::uint64_t seed, int cells);

}  // namespace qddot::measure
