#include "experiments/advice/drawn_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "experiments/advice/draws.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::judged_advice {
namespace {

Scene generated(const char* generator, const GeneratorValues& values) {
  return generate(*find_generator(generator), values, generator);
}

Scene oscillator(Draws& draw) {
  return generated("oscillator", {{"mass", draw.by_logarithm(0.1, 10)},
                                  {"stiffness", draw.by_logarithm(1, 1e4)},
                                  {"velocity", draw.between(-5, 5)}});
}

Scene orbit(Draws& draw) {
  return generated("orbit", {{"stiffness", draw.by_logarithm(10, 1e4)},
                             {"radius", draw.between(0.6, 2)},
                             {"speed", draw.between(0.2, 6)}});
}

Scene pair(Draws& draw) {
  return generated("pair", {{"mass_1", draw.by_logarithm(0.1, 10)},
                            {"stiffness", draw.by_logarithm(10, 1e5)},
                            {"stretch", draw.between(0.7, 1.5)},
                            {"spin", draw.between(0, 4)}});
}

Scene pendulum(Draws& draw) {
  return generated("pendulum", {{"stiffness", draw.by_logarithm(30, 1e8)},
                                {"angle", draw.between(0.1, 2.8)},
                                {"speed", draw.happens(0.5) ? 0 : draw.between(0, 2)}});
}

Scene chain(Draws& draw) {
  return generated("chain", {{"nodes", draw.whole(3, 10000)},
                             {"stiffness", draw.by_logarithm(1e3, 1e9)},
                             {"pinned_ends", draw.happens(0.3) ? 2 : 1}});
}

// A chain whose middle third is up to 1e8 times as stiff as the rest.
Scene stiff_chain(Draws& draw) {
  const int nodes = draw.whole(6, 300);
  const double soft = 1000.0 * nodes * 9.81, ratio = draw.by_logarithm(1, 1e8);
  Scene scene = generated("chain", {{"nodes", nodes}, {"stiffness", soft}});
  const std::size_t count = scene.springs.size();
  for (std::size_t i = count / 3; i < count - count / 3; ++i) {
    scene.springs[i].law.stiffness = soft * ratio;
  }
  if (ratio > 2 && draw.happens(0.7)) scene.stiff_above = soft * std::sqrt(ratio);
  return scene;
}

Scene cloth(Draws& draw) {
  const double k = draw.by_logarithm(30, 1e6);
  return generated("cloth", {{"nodes", draw.whole(2, 100)},
                             {"structural_stiffness", k},
                             {"shear_stiffness", k * draw.by_logarithm(0.01, 1)},
                             {"bending_stiffness", k * draw.by_logarithm(0.001, 1)},
                             {"gravity", draw.happens(0.9) ? 9.81 : 1.62}});
}

Scene framed_cloth(Draws& draw) {
  const double k = draw.by_logarithm(100, 1e4);
  return generated("framed_cloth", {{"nodes", draw.whole(4, 60)},
                                    {"structural_stiffness", k},
                                    {"frame_stiffness", k * draw.by_logarithm(1, 1e8)}});
}

Scene lattice(Draws& draw) {
  return generated("lattice", {{"nodes_x", draw.whole(2, 60)},
                               {"nodes_y", draw.whole(2, 13)},
                               {"nodes_z", draw.whole(2, 13)},
                               {"stiffness", draw.by_logarithm(1e3, 1e7)}});
}

Scene fpu(Draws& draw) {
  return generated(
      "fpu", {{"stiff_springs", draw.whole(1, 100)}, {"frequency", draw.by_logarithm(5, 1000)}});
}

Scene strut(Draws& draw) {
  return generated("strut", {{"nodes", draw.whole(4, 60)},
                             {"stiffness", draw.by_logarithm(100, 1e6)},
                             {"compression", draw.between(0.5, 1)},
                             {"bend", draw.by_logarithm(1e-4, 0.1)}});
}

// A bent sheet, a tube or a torus of triangles whose nodes are pushed a little, its edges springs.
Scene surface(Draws& draw) {
  const int around = draw.whole(4, 80), along = draw.whole(3, 80), form = draw.one_of(3);
  const double noise = draw.between(0, 0.2), turn = 2 * std::numbers::pi;
  const double mass = draw.by_logarithm(0.1, 10) / (around * along);
  const double stiffness = draw.by_logarithm(100, 1e6);
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const auto point = [&](double u, double s) -> Eigen::Vector3d {
    if (form == 0) return {u, s, 0.2 * std::sin(3 * u) * std::sin(2 * s)};
    if (form == 1) return {0.3 * std::cos(turn * u), 0.3 * std::sin(turn * u), s};
    const double r = 1 + 0.3 * std::cos(turn * u);
    return {r * std::cos(turn * s), 0.3 * std::sin(turn * u), r * std::sin(turn * s)};
  };
  const bool closes_around = form > 0, closes_along = form == 2;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      Node node;
      node.position = point(static_cast<double>(i) / around, static_cast<double>(j) / along) +
                      noise * draw.in_box(3, 1.0 / std::max(around, along));
      node.mass = mass;
      node.pinned = (form == 0 && i == 0) || (form == 1 && j == along - 1);
      scene.nodes.push_back(node);
    }
  }
  if (form == 2) scene.nodes[0].pinned = draw.happens(0.7);
  const auto join = [&](int i, int j, int k, int l) {
    if ((!closes_around && k >= around) || (!closes_along && (l >= along || l < 0))) return;
    const auto index = [&](int a, int b) {
      return static_cast<std::size_t>((a % around) * along + (b + along) % along);
    };
    const std::size_t one = index(i, j), other = index(k, l);
    if (one == other) return;
    Spring spring;
    spring.nodes = {one, other};
    spring.law.stiffness = stiffness;
    spring.law.rest_length = (scene.nodes[one].position - scene.nodes[other].position).norm();
    scene.springs.push_back(spring);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      join(i, j, i + 1, j);
      join(i, j, i, j + 1);
      join(i, j, i + 1, j + 1);
    }
  }
  return scene;
}

// Nodes anywhere in a box, each on springs to its nearest ones and to some others.
Scene network(Draws& draw) {
  const int d = 1 + draw.one_of(3), nodes = draw.whole(2, 2000),
            neighbours = 1 + draw.one_of(2 * d);
  const double size = draw.by_logarithm(0.1, 10), soft = draw.by_logarithm(10, 1e4);
  const double ratio = draw.happens(0.5) ? 1 : draw.by_logarithm(1, 1e8);
  const double stretch = draw.happens(0.5) ? 0 : draw.between(0, 0.3);
  const double quartic = draw.happens(0.2) ? soft / (size * size) : 0;
  Scene scene;
  scene.dimension = d;
  if (draw.happens(0.7)) scene.gravity[d - 1] = -9.81;
  for (int i = 0; i < nodes; ++i) {
    Node node;
    node.position = draw.in_box(d, size);
    node.mass = draw.by_logarithm(0.05, 0.5);
    node.pinned = draw.happens(0.05);
    if (draw.happens(0.3)) node.velocity = draw.in_box(d, size);
    scene.nodes.push_back(node);
  }
  std::set<std::array<std::size_t, 2>> joined;
  const auto join = [&](std::size_t one, std::size_t other) {
    if (one == other || !joined.insert({std::min(one, other), std::max(one, other)}).second) return;
    const double length = (scene.nodes[one].position - scene.nodes[other].position).norm();
    Spring spring;
    spring.nodes = {one, other};
    spring.law.stiffness = soft * (draw.happens(0.3) ? ratio : draw.between(0.5, 1));
    spring.law.rest_length = length * (1 + stretch * draw.between(-1, 1));
    spring.law.quartic = quartic;
    scene.springs.push_back(spring);
  };
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    std::vector<std::pair<double, std::size_t>> others;
    for (std::size_t j = 0; j < scene.nodes.size(); ++j) {
      if (j != i) others.push_back({(scene.nodes[i].position - scene.nodes[j].position).norm(), j});
    }
    std::ranges::sort(others);
    for (int k = 0; k < std::min<int>(neighbours, static_cast<int>(others.size())); ++k)
      join(i, others[static_cast<std::size_t>(k)].second);
    if (nodes > 4 && draw.happens(0.05)) join(i, static_cast<std::size_t>(draw.one_of(nodes)));
  }
  if (ratio > 10 && draw.happens(0.5)) scene.stiff_above = soft * std::sqrt(ratio);
  return scene;
}

struct Kind {
  const char* name;
  Scene (*draw)(Draws& draw);
};

constexpr std::array kinds = {
    Kind{"oscillator", oscillator}, Kind{"orbit", orbit},     Kind{"pair", pair},
    Kind{"pendulum", pendulum},     Kind{"chain", chain},     Kind{"stiff chain", stiff_chain},
    Kind{"cloth", cloth},           Kind{"cloth", cloth},     Kind{"framed cloth", framed_cloth},
    Kind{"lattice", lattice},       Kind{"fpu", fpu},         Kind{"strut", strut},
    Kind{"surface", surface},       Kind{"surface", surface}, Kind{"network", network},
    Kind{"network", network},       Kind{"network", network}};

}  // namespace

Case drawn_case(std::uint64_t seed) {
  Draws draw(seed);
  const Kind& kind = kinds[static_cast<std::size_t>(draw.one_of(std::ssize(kinds)))];
  Case drawn{.seed = seed, .kind = kind.name, .scene = kind.draw(draw)};
  drawn.scene.name = fmt::format("case {} ({})", seed, kind.name);
  const Model model(drawn.scene);
  const double w =
      model.system().size() > 0 ? frequency_at_least(model.system(), model.initial().q) : 0;
  constexpr double most_work = 1e8, fewest_steps = 100, most_steps = 1e5;
  const double size = static_cast<double>(drawn.scene.springs.size() + 10);
  const double steps =
      draw.by_logarithm(fewest_steps, std::clamp(most_work / size, 2 * fewest_steps, most_steps));
  drawn.until = w > 0 && std::isfinite(w) ? 2 * steps / w : 1;
  drawn.scene.until = drawn.until;
  drawn.accuracy = draw.by_logarithm(1e-10, 1e-1);
  return drawn;
}

}  // namespace qddot::judged_advice
