#pragma once

#include <string>
#include <vector>

#include "experiments/advice/hard_case.hpp"

namespace qddot::judged_advice {

// The motion of a case as drawn, by PlainMotion in extended precision. It is independent of the
// library's forces, reductions and methods.
struct TrueMotion {
  std::string unknown_because{};          // empty if it is known
  std::vector<double> times{};            // at random, and the end [s]
  std::vector<std::vector<Node>> path{};  // all nodes at these times
  // The distance to a second motion [m]: the largest of a node at these times, and at the end. That
  // one begins one rounding away in all drawn directions and has ten times the tolerance.
  double conditioning = 0, conditioning_at_end = 0;
  double energy_conditioning = 0;  // the effect of these roundings on the energy [J]

  bool is_known() const { return unknown_because.empty(); }
};

// The reason why a motion is not known from some time on: its massless joints have no equilibrium.
inline constexpr const char* goes_slack = "a massless joint goes slack";

TrueMotion true_motion(const HardCase& hard);

}  // namespace qddot::judged_advice
