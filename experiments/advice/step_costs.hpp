#pragma once

#include <array>
#include <vector>

#include "qddot/integrators/method.hpp"

namespace qddot::judged_advice {

// The sizes that steps are timed at, in unknowns, about.
constexpr std::array<double, 4> sizes_of_costs = {3, 30, 300, 3000};

// The time of a step of a method in steps of Verlet's method, at each of the sizes; NaN where it
// did not make its steps.
struct MeasuredCost {
  const Method* method = nullptr;
  std::array<double, sizes_of_costs.size()> steps{};
};

// Times a step of each fixed-step method that has forecasts, as the median over a chain, a cloth
// and a lattice. Explicit methods step at half of their limit, implicit ones at h w_max = 10. The
// table in measure/advice/step_cost.cpp has these numbers.
std::vector<MeasuredCost> measured_costs();

}  // namespace qddot::judged_advice
