#include "experiments/scaling/phase_table.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <tuple>

#include "experiments/kit/allowed_options.hpp"
#include "qddot/scene/generators.hpp"

namespace qddot::scaling {
namespace {

Scene chain(double nodes) {
  return generate(*find_generator("chain"), {{"nodes", std::round(nodes)}}, "chain");
}

Scene cloth(double nodes) {
  return generate(*find_generator("cloth"), {{"nodes", std::round(std::sqrt(nodes))}}, "cloth");
}

Scene lattice(double nodes) {
  const double edge = std::round(std::cbrt(nodes));
  return generate(*find_generator("lattice"),
                  {{"nodes_x", edge}, {"nodes_y", edge}, {"nodes_z", edge}}, "lattice");
}

double linear(double n) { return n; }

const std::string factors = "factorization", iterations = "iterations";
constexpr double fitted_range = 31.7;  // one and a half decades, and a little for rounded sizes

auto key(const PhaseCost& cost) { return std::tie(cost.scene, cost.method, cost.phase); }

const PhaseCost* last_of(const std::vector<PhaseCost>& all, const std::string& scene,
                         const std::string& method, const std::string& phase) {
  const auto found = std::ranges::find(all.rbegin(), all.rend(), std::tie(scene, method, phase),
                                       [](const PhaseCost& cost) { return key(cost); });
  return found == all.rend() ? nullptr : &*found;
}

// The growth of a phase's seconds and bytes with the number of nodes, by theory and up to a
// constant. It is n, except for phases that depend on the factors (see SizedScenes).
double growth_of_seconds(const SizedScenes& scenes, const std::string& phase, double nodes) {
  if (phase == factors) return scenes.factorization(nodes);
  if (phase == iterations) return scenes.iterations(nodes);
  return phase == "solve" ? scenes.fill(nodes) : nodes;
}

double growth_of_bytes(const SizedScenes& scenes, const std::string& phase, double nodes) {
  const bool has_factors = phase == "symbolic" || phase == factors || phase == "step";
  return has_factors ? scenes.fill(nodes) : nodes;
}

using Growth = double (*)(const SizedScenes&, const std::string&, double);

double expected(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                const std::string& method, const std::string& phase, double nodes,
                double PhaseCost::*number, Growth growth) {
  const PhaseCost* last = last_of(all, scenes.name, method, phase);
  if (!last) return 0;
  return last->*number * growth(scenes, phase, nodes) / growth(scenes, phase, last->nodes);
}

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

const std::vector<SizedScenes>& sized_scenes() {
  static const std::vector<SizedScenes> all = {
      {"chain", chain, 1, linear, linear, [](double n) { return n * n; }},
      {"cloth", cloth, 6, [](double n) { return n * std::sqrt(n); },
       [](double n) { return n * std::log(n); }, [](double n) { return n * std::sqrt(n); }},
      {"lattice", lattice, 13, [](double n) { return n * n; },
       [](double n) { return n * std::cbrt(n); }, [](double n) { return n * std::cbrt(n); }}};
  return all;
}

const SizedScenes& find_sized_scenes(const std::string& name) {
  return named(name, sized_scenes(), &SizedScenes::name, "--scenes", "one of them");
}

std::vector<double> sizes_between(double least, double most, int in_a_decade) {
  std::vector<double> sizes;
  const double step = 1.0 / in_a_decade;
  for (int i = 0;; ++i) {
    const double size = least * std::pow(10, i * step);
    if (size > most * std::pow(10, -step / 2)) break;
    sizes.push_back(size);
  }
  sizes.push_back(most);
  return sizes;
}

double expected_seconds(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                        const std::string& method, const std::string& phase, double nodes) {
  return expected(all, scenes, method, phase, nodes, &PhaseCost::seconds, growth_of_seconds);
}

double expected_bytes(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                      const std::string& method, const std::string& phase, double nodes) {
  return expected(all, scenes, method, phase, nodes, &PhaseCost::bytes, growth_of_bytes);
}

std::vector<Exponent> exponents_of(const std::vector<PhaseCost>& all) {
  std::vector<std::vector<PhaseCost>> groups;
  for (const PhaseCost& cost : all) {
    auto group =
        std::ranges::find_if(groups, [&](const auto& g) { return key(g.front()) == key(cost); });
    if (group == groups.end()) group = groups.insert(group, std::vector<PhaseCost>());
    group->push_back(cost);
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
