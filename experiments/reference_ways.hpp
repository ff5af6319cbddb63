#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/reference.hpp"
#include "experiments/timing.hpp"
#include "integrators/method.hpp"

namespace qddot {

// The end of a motion computed in one way.
struct Solution {
  State end{};
  Scales scales{};
  double knob = 0;
  std::string made_by{};
  std::vector<State> path{};  // on the way, at some of the samples, the end included
};

// The motion from `initial` by a method with these knobs. Its scales are those seen at the ends of
// `samples` equal parts of the time; about a hundred of these are its path. Nothing where it does
// not reach the end in so many seconds.
std::optional<Solution> seen_run(const ReducedScene& scene, const Method& method,
                                 const Knobs& knobs, const State& initial, double until,
                                 std::int64_t samples, double seconds);

// By Kahan and Li's composition of order 8 with steps of h [s], its scales seen at each.
std::optional<Solution> composition(const ReducedScene& scene, const State& initial, double until,
                                    double h, double seconds);

// Fehlberg 7(8) in the variables (q - q0) / displacement and v / speed, all of order one.
std::optional<Solution> fehlberg(const ReducedScene& scene, double until, double tolerance,
                                 const Scales& scales, double seconds);

// The reference whose end is that of `one`, certified to what `other` differs from it.
Reference joined(const ReducedScene& scene, const Solution& one, const Solution& other);

}  // namespace qddot
