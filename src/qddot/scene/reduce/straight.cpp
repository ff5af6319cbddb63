#include "qddot/scene/reduce/straight.hpp"

#include <algorithm>

#include "qddot/algebra/effective_mass.hpp"

namespace qddot::reduce {
namespace {

// A spring on the line: d = c - x_i + s x_j, or d = c - x_i if there is no node j.
struct LineSpring {
  int i, j;  // j = -1: none
  double s, c;
  SpringLaw law;
  Holds holds;

  double difference(const std::vector<double>& x) const {
    return c - x[i] + (j < 0 ? 0 : s * x[j]);
  }
};

std::vector<LineSpring> springs_of(const Network& network) {
  std::vector<LineSpring> all;
  for (const auto& link : network.links) {
    all.push_back({link.i, link.j, 1, 0, link.law, link.holds});
  }
  for (const auto& image : network.image_links) {
    all.push_back({image.i, image.j, image.mirror[0], 0, image.law, image.holds});
  }
  for (const auto& anchor : network.anchors) {
    all.push_back({anchor.i, -1, 0, anchor.point[0], anchor.law, anchor.holds});
  }
  return all;
}

bool may_be_straightened(const std::vector<LineSpring>& springs) {
  return std::ranges::all_of(springs,
                             [](const LineSpring& spring) {
                               return spring.law.quartic == 0 && spring.holds == Holds::always;
                             }) &&
         std::ranges::any_of(springs,
                             [](const LineSpring& spring) { return spring.law.rest_length > 0; });
}

// The coordinate of each node: its unknown, or zero if it has none.
std::vector<double> coordinates(const Network& network, const Vec& q) {
  std::vector<double> x;
  Index next = 0;
  for (Index i = 0; i < network.node_mass.size(); ++i) {
    const bool is_zero = !network.zero_coordinates.empty() && (network.zero_coordinates[i] & 1);
    x.push_back(is_zero ? 0 : q[next++]);
  }
  return x;
}

// The network in which each spring keeps the direction in which it lies at `x`. `springs` are all
// of its springs, in their order.
Network with_directions(Network network, const std::vector<LineSpring>& springs,
                        const std::vector<double>& x) {
  auto spring = springs.begin();
  const auto keep_direction = [&](auto& drawn) {
    for (auto& one : drawn) {
      const bool is_backwards = spring++->difference(x) < 0;
      if (one.law.rest_length > 0) one.direction = is_backwards ? -1 : 1;
    }
  };
  keep_direction(network.links);
  keep_direction(network.image_links);
  keep_direction(network.anchors);
  return network;
}

// Kinetic energy about the centre of mass.
double relative_kinetic(const Vec& mass, const Vec& v) {
  const double total = mass.sum();
  if (total == 0) return 0;
  const double mean = mass.dot(v) / total;
  return 0.5 * mass.dot((v.array() - mean).square().matrix());
}

// A small margin, so that rounding does not decide.
constexpr double margin = 1 - 1e-6;

}  // namespace

std::optional<Network> straightened(const Network& network, const Vec& q, const Vec& v,
                                    bool is_loaded) {
  if (network.dimension != 1) return {};
  const auto springs = springs_of(network);
  if (!may_be_straightened(springs)) return {};
  const auto x = coordinates(network, q);
  Network straight = with_directions(network, springs, x);
  const auto system = make_mass_spring(straight);
  SymmetricMatrix k = system->stiffness_pattern();
  system->stiffness(q, k);

  const auto none_turns = [&](double energy, const std::vector<double>& at) {
    return std::ranges::all_of(springs, [&](const LineSpring& spring) {
      const double d = spring.difference(at), l0 = spring.law.rest_length;
      return l0 == 0 ||
             (d * spring.difference(x) > 0 && energy < margin * 0.5 * spring.law.stiffness * d * d);
    });
  };
  EffectiveMass matrix(*system);
  if (matrix.factorize_positive(0, 1, k)) {
    Vec f(q.size()), to_equilibrium(q.size());
    system->force(q, f);
    matrix.solve(f, to_equilibrium);
    const double energy = system->kinetic(v) + 0.5 * f.dot(to_equilibrium);
    if (none_turns(energy, coordinates(network, q + to_equilibrium))) return straight;
  } else if (!is_loaded && network.anchors.empty() && network.image_links.empty() &&
             network.zero_coordinates.empty()) {
    double energy = relative_kinetic(system->mass(), v);
    double least = INFINITY;
    for (const LineSpring& spring : springs) {
      const SpringLaw& law = spring.law;
      energy += law.energy(std::abs(spring.difference(x)));
      if (law.rest_length > 0) least = std::min(least, law.energy(0.0));
    }
    if (energy < margin * least) return straight;
  }
  return {};
}

}  // namespace qddot::reduce
