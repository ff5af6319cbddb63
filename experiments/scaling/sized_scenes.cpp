#include "experiments/scaling/sized_scenes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"

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
  const auto found = std::ranges::find(sized_scenes(), name, &SizedScenes::name);
  if (found != sized_scenes().end()) return *found;
  std::vector<std::string> names;
  for (const SizedScenes& scenes : sized_scenes()) names.push_back(scenes.name);
  throw InvalidInput(
      fmt::format("--scenes: {} is not one of them; allowed are {}", name, fmt::join(names, ", ")));
}

}  // namespace qddot::scaling
