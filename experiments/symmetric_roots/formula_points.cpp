#include "experiments/symmetric_roots/formula_points.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "experiments/kit/progress.hpp"
#include "integrators/methods/tables.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::spurious_roots {
namespace {

constexpr int h_omegas_of_gap = 8;

FormulaPoint point_of(const Coefficients& formula, std::vector<double> cosines, std::string method,
                      double at, const OrbitSwing& orbit) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  FormulaPoint point{.steps = formula.steps(),
                     .method = std::move(method),
                     .cosines = std::move(cosines),
                     .limit = stability_limit(formula),
                     .phase_error = nothing,
                     .gap = nothing,
                     .energy_swing = nothing};
  if (point.limit > at) {
    point.phase_error = phase_error(formula, at);
    std::vector<double> h_omegas;
    for (int i = 1; i <= h_omegas_of_gap; ++i) h_omegas.push_back(at * i / h_omegas_of_gap);
    point.gap = root_gap(formula, h_omegas);
    point.energy_swing = orbit(formula);
  }
  return point;
}

}  // namespace

std::vector<FormulaPoint> registered_points(double at, const OrbitSwing& orbit) {
  std::vector<FormulaPoint> points;
  for (const SymmetricFormula* formula :
       {&registered::symmetric4_formula(), &registered::symmetric6_formula(),
        &registered::symmetric8_formula(), &registered::symmetric10_formula()}) {
    std::vector<double> cosines;
    for (const auto cosine : cosines_of_roots(formula->cofactor())) {
      cosines.push_back(cosine.real());
    }
    std::ranges::sort(cosines, std::greater());
    points.push_back(point_of(coefficients_of(*formula), cosines,
                              fmt::format("symmetric{}", formula->steps), at, orbit));
  }
  return points;
}

std::vector<FormulaPoint> sampled_points(int steps, int samples, double at,
                                         const OrbitSwing& orbit) {
  const int pairs = steps / 2 - 1;
  std::vector<FormulaPoint> points;
  for (int i = 1; i <= pairs * samples; ++i) {
    stop_if_interrupted();
    progress().now_at(fmt::format("formulas of {} steps, {} of {}", steps, i, pairs * samples));
    const std::vector<double> cosines = sampled_cosines(i, pairs);
    points.push_back(point_of(formula_of_cosines(cosines), cosines, "", at, orbit));
  }
  return points;
}

}  // namespace qddot::spurious_roots
