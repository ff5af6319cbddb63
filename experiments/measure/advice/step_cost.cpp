#include "qddot/measure/advice/step_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace qddot::measure {
namespace {

struct Cost {
  std::string_view method;
  std::array<double, 4> steps;  // of Verlet's, at 3, 30, 300 and 3000 unknowns
};

// Medians over the scenes of the training cases (see drawn_case.hpp in experiments/advice), Zen 4.
constexpr std::array costs = {
    Cost{"verlet", {1, 1, 1, 1}},
    Cost{"position_verlet", {1.2, 1.13, 1.06, 1.07}},
    Cost{"symmetric4", {1.24, 1.14, 1.05, 1.03}},
    Cost{"symmetric6", {1.35, 1.22, 1.14, 1.09}},
    Cost{"symmetric8", {1.46, 1.28, 1.25, 1.21}},
    Cost{"symmetric10", {1.6, 1.38, 1.4, 1.3}},
    Cost{"takahashi_imada4", {1.86, 1.9, 1.95, 1.94}},
    Cost{"rk4", {5.06, 4.24, 4.05, 4.47}},
    Cost{"blanes_moan4", {4.62, 5.35, 5.6, 5.4}},
    Cost{"blanes_moan6", {8.44, 9.26, 10, 10.2}},
    Cost{"kahan_li8", {12.5, 14, 14.6, 15}},
    Cost{"linear_midpoint", {4.5, 8.4, 20, 30}},
    Cost{"linear_midpoint4", {21.9, 44.7, 122, 150}},
    Cost{"implicit_midpoint", {13.5, 20, 40, 60}},
    Cost{"trapezoidal", {5.1, 9.2, 30, 45}},
    Cost{"generalized_alpha", {6, 10, 30, 45}},
    Cost{"bdf2", {6.5, 11.4, 30, 45}},
    Cost{"trbdf2", {10.5, 18.8, 50, 75}},
    Cost{"discrete_gradient", {16, 19, 40, 60}},
    Cost{"arkode_implicit_midpoint", {40, 30, 40, 60}},
    Cost{"arkode_sdirk2", {72, 37, 60, 100}},
    Cost{"arkode_trbdf2", {74, 47, 60, 100}},
};

}  // namespace

double usual_step_cost(const Method& method, Index unknowns) {
  const auto found = std::ranges::find(costs, std::string_view(method.name), &Cost::method);
  if (found == costs.end()) return std::numeric_limits<double>::infinity();
  const double place =
      std::clamp(std::log10(static_cast<double>(std::max<Index>(unknowns, 1)) / 3), 0.0, 3.0);
  const auto low = static_cast<std::size_t>(std::min(std::floor(place), 2.0));
  const double part = place - static_cast<double>(low);
  return found->steps[low] * std::pow(found->steps[low + 1] / found->steps[low], part);
}

double steps_to_analyse(Index unknowns) {
  constexpr Index small = 300;  // where it takes no time
  return unknowns > small ? 10 : 0;
}

double forces_to_begin(const Method& method) {
  // Sweeps of deferred correction over the first steps (see symmetric_multistep.hpp).
  return method.recurrence_roots ? method.order / 2.0 * (method.order - 1) : 0;
}

}  // namespace qddot::measure
