#include "experiments/scaling/phase_table.hpp"

#include <algorithm>
#include <ranges>
#include <tuple>

namespace qddot::scaling {
namespace {

const std::string factors = "factorization", iterations = "iterations";
constexpr double fitted_range = 31.7;  // one and a half decades, and a little for rounded sizes

auto key(const PhaseCost& cost) { return std::tie(cost.scene, cost.method, cost.phase); }

const PhaseCost* last_of(const std::vector<PhaseCost>& all, const std::string& scene,
                         const std::string& method, const std::string& phase) {
  const auto found = std::ranges::find(all.rbegin(), all.rend(), std::tie(scene, method, phase),
                                       [](const PhaseCost& cost) { return key(cost); });
  return found == all.rend() ? nullptr : &*found;
}

using Growth = double (*)(const SizedScenes&, const std::string&, double);

// Adds the exponent of some numbers of the costs, if there are enough, with the growth of phase
// `law`.
void add_exponent(std::vector<Exponent>& exponents, const std::vector<PhaseCost>& costs,
                  const std::string& phase, double PhaseCost::*number, Growth growth,
                  const std::string& law) {
  const SizedScenes& scenes = find_sized_scenes(costs.back().scene);
  std::vector<double> n, y, by_theory;
  for (const PhaseCost& cost : costs) {
    if (cost.nodes * fitted_range < costs.back().nodes || !(cost.*number > 0)) continue;
    n.push_back(cost.nodes);
    y.push_back(cost.*number);
    by_theory.push_back(growth(scenes, law, cost.nodes));
  }
  if (n.size() < 3) return;
  exponents.push_back({costs.back().scene, costs.back().method, phase, fit_power_law(n, y),
                       fit_power_law(n, by_theory).exponent, n.front(), n.back()});
}

}  // namespace

double growth_of_seconds(const SizedScenes& scenes, const std::string& phase, double nodes) {
  if (phase == factors) return scenes.factorization(nodes);
  if (phase == iterations) return scenes.iterations(nodes);
  return phase == "solve" ? scenes.fill(nodes) : nodes;
}

double growth_of_bytes(const SizedScenes& scenes, const std::string& phase, double nodes) {
  const bool has_factors = phase == "symbolic" || phase == "factorization" || phase == "step";
  return has_factors ? scenes.fill(nodes) : nodes;
}

double expected_seconds(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                        const std::string& method, const std::string& phase, double nodes) {
  const PhaseCost* last = last_of(all, scenes.name, method, phase);
  if (!last) return 0;
  return last->seconds * growth_of_seconds(scenes, phase, nodes) /
         growth_of_seconds(scenes, phase, last->nodes);
}

double expected_bytes(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                      const std::string& method, const std::string& phase, double nodes) {
  const PhaseCost* last = last_of(all, scenes.name, method, phase);
  if (!last) return 0;
  return last->bytes * growth_of_bytes(scenes, phase, nodes) /
         growth_of_bytes(scenes, phase, last->nodes);
}

std::vector<Exponent> exponents_of(const std::vector<PhaseCost>& all) {
  std::vector<std::vector<PhaseCost>> groups;
  for (const PhaseCost& cost : all) {
    const auto group =
        std::ranges::find_if(groups, [&](const auto& g) { return key(g.front()) == key(cost); });
    if (group == groups.end()) {
      groups.push_back({cost});
    } else {
      group->push_back(cost);
    }
  }
  std::vector<Exponent> exponents;
  for (const auto& costs : groups) {
    const std::string& phase = costs.front().phase;
    // A whole step grows as its steepest phase.
    std::string steepest = phase;
    for (const std::string& part : {factors, iterations}) {
      if (phase == "step" && last_of(all, costs.front().scene, costs.front().method, part)) {
        steepest = part;
      }
    }
    add_exponent(exponents, costs, phase, &PhaseCost::seconds, growth_of_seconds, steepest);
    if (phase == factors) {
      add_exponent(exponents, costs, "fill", &PhaseCost::bytes, growth_of_bytes, phase);
    }
  }
  return exponents;
}

}  // namespace qddot::scaling
