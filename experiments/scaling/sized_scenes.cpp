#include "experiments/scaling/sized_scenes.hpp"

#include <cmath>

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

}  // namespace qddot::scaling
