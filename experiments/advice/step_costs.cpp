#include "experiments/advice/step_costs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::judged_advice {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Scenes of about so many unknowns; no unknown is reduced away.
std::vector<ReducedScene> scenes_of(double unknowns) {
  const auto all = Reductions::only({Reduction::pins, Reduction::duplicates});
  const auto drawn = [&](const char* generator, const GeneratorValues& values) {
    return ReducedScene(generate(*find_generator(generator), values, generator), all);
  };
  const double nodes = std::max(2.0, std::round(unknowns / 3) + 1);
  const double side = std::max(2.0, std::round(std::sqrt(unknowns / 3)));
  const double across = std::max(2.0, std::round(std::cbrt(unknowns / 3)));
  std::vector<ReducedScene> scenes;
  scenes.push_back(drawn("chain", {{"nodes", nodes}}));
  scenes.push_back(drawn("cloth", {{"nodes", side}}));
  scenes.push_back(
      drawn("lattice", {{"nodes_x", across}, {"nodes_y", across}, {"nodes_z", across}}));
  return scenes;
}

// Seconds of a step: of forty steps after the first twenty.
double seconds_of_step(const Method& method, const ReducedScene& scene, double w) {
  constexpr double implicit_h_omega = 10, before = 20, after = 60, passes = 0.1;
  const double limit = linear_limit(method);
  const double h = (std::isfinite(limit) ? limit / 2 : implicit_h_omega) / w;
  const auto integrator = make_integrator(method, scene.system(), {.step_size = h});
  bool is_good = true;
  const auto seconds = [&](double steps) {
    return least_seconds(passes, [&] {
      State state = scene.initial();
      is_good = is_good && integrator->advance(state, steps * h).outcome == Outcome::reached_end;
    });
  };
  const double step = (seconds(after) - seconds(before)) / (after - before);
  return is_good ? step : unknown;
}

}  // namespace

std::vector<MeasuredCost> measured_costs() {
  std::vector<MeasuredCost> costs;
  for (const Method& method : methods()) {
    if (!has_linear_step(method) || method.order < 2 || !method.stock_of.empty() ||
        method.asks(Need::constant_stiffness))
      continue;
    costs.push_back({&method, {}});
  }
  for (std::size_t size = 0; size < sizes_of_costs.size(); ++size) {
    const auto scenes = scenes_of(sizes_of_costs[size]);
    std::vector<double> w, verlet;
    for (const ReducedScene& scene : scenes) {
      w.push_back(quick_frequency(scene.system(), scene.initial().q));
      verlet.push_back(seconds_of_step(*find_method("verlet"), scene, w.back()));
    }
    for (MeasuredCost& cost : costs) {
      std::vector<double> ratios;
      for (std::size_t i = 0; i < scenes.size(); ++i) {
        const double step = seconds_of_step(*cost.method, scenes[i], w[i]);
        if (std::isfinite(step)) ratios.push_back(step / verlet[i]);
      }
      cost.steps[size] = ratios.empty() ? unknown : median(ratios);
    }
  }
  return costs;
}

}  // namespace qddot::judged_advice
