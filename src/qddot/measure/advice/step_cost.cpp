#include "qddot/measure/advice/step_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "qddot/model/capabilities.hpp"

namespace qddot::inline measure {
namespace {

struct Cost {
  std::string_view method;
  std::array<double, 4> steps;  // of Verlet's, at 3, 30, 300 and 3000 unknowns
};

// Medians over a chain, a cloth and a lattice, on one core of an AMD EPYC (Zen 4), made by
//   advice --step-costs --out DIR
constexpr std::array costs = {
    Cost{"implicit_midpoint", {13.8, 28.8, 60.3, 68.2}},
    Cost{"trapezoidal", {12.3, 17.9, 34.2, 39.7}},
    Cost{"generalized_alpha", {12.4, 17.2, 34.4, 40.4}},
    Cost{"hht", {12.6, 17.8, 35.2, 42.3}},
    Cost{"bdf2", {12.7, 18.4, 36.6, 42.8}},
    Cost{"trbdf2", {20.9, 30.2, 60.3, 70}},
    Cost{"discrete_gradient", {18.5, 36.7, 65.5, 74.8}},
    Cost{"verlet", {1, 1, 1, 1}},
    Cost{"position_verlet", {1.19, 1.07, 1.05, 1.07}},
    Cost{"rk4", {4.91, 4.29, 4.07, 6.28}},
    Cost{"blanes_moan4", {5.55, 5.3, 5.68, 5.8}},
    Cost{"blanes_moan6", {9.92, 9.66, 10.3, 11.7}},
    Cost{"kahan_li8", {14.9, 14.7, 15.8, 17.6}},
    Cost{"takahashi_imada4", {1.81, 1.87, 1.98, 2.05}},
    Cost{"symmetric4", {1.15, 1.13, 1.03, 1.02}},
    Cost{"symmetric6", {1.24, 1.19, 1.09, 1.04}},
    Cost{"symmetric8", {1.3, 1.36, 1.14, 1.11}},
    Cost{"symmetric10", {1.27, 1.28, 1.2, 1.14}},
    Cost{"linear_midpoint", {4.94, 7.6, 34.1, 184}},
    Cost{"linear_midpoint4", {22.8, 36.6, 172, 922}},
    Cost{"arkode_implicit_midpoint", {60.9, 28.8, 42.5, 72.3}},
    Cost{"arkode_sdirk2", {86.3, 46.4, 72.3, 132}},
    Cost{"arkode_trbdf2", {90.2, 48.3, 77.6, 131}},
};

double cost_at(const Cost& cost, Index unknowns) {
  const double place =
      std::clamp(std::log10(static_cast<double>(std::max<Index>(unknowns, 1)) / 3), 0.0, 3.0);
  const auto low = static_cast<std::size_t>(std::min(std::floor(place), 2.0));
  const double part = place - static_cast<double>(low);
  return cost.steps[low] * std::pow(cost.steps[low + 1] / cost.steps[low], part);
}

// The number of unknowns that a step solves for.
Index unknowns_solved_for(const Method& method, const System& system) {
  const Split* split = method.solves_stiff_part ? split_of(system) : nullptr;
  return split ? static_cast<Index>(split->stiff_unknowns.size()) : system.size();
}

}  // namespace

double usual_step_cost(const Method& method, const System& system) {
  const auto found = std::ranges::find(costs, std::string_view(method.name), &Cost::method);
  if (found == costs.end()) return std::numeric_limits<double>::infinity();
  const Index all = system.size(), solved_for = unknowns_solved_for(method, system);
  if (solved_for == all) return cost_at(*found, all);
  // The table's cost is in Verlet steps on `solved_for` unknowns. One Verlet step on all of them is
  // added.
  return 1 +
         cost_at(*found, solved_for) * static_cast<double>(solved_for) / static_cast<double>(all);
}

double steps_to_begin(const Method& method, const System& system) {
  constexpr Index small = 300;  // below this size the analysis takes no time
  // The additional time of a run of one step, in steps. Measured on 500 to 10^4 unknowns: 1 to 11
  // for methods with one solve a step, 4 to 260 for Newton's iterations.
  constexpr double linear = 5, newton = 40;
  if (!method.is(Trait::implicit) || unknowns_solved_for(method, system) <= small) return 0;
  return method.solves_stiff_part ? linear : newton;
}

double forces_to_begin(const Method& method) {
  // Sweeps of deferred correction over the first steps (see symmetric_multistep.hpp).
  return method.recurrence_roots ? method.order / 2.0 * (method.order - 1) : 0;
}

}  // namespace qddot::inline measure
