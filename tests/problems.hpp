#pragma once

#include <cmath>
#include <random>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot {
inline namespace tests {

// A network and where it starts.
struct Problem {
  Network network;
  State initial;
};

// Calls change(spring) for every spring of the network.
template <class Change>
void for_springs(Network& network, const Change& change) {
  for (auto& link : network.links) change(link);
  for (auto& image : network.image_links) change(image);
  for (auto& anchor : network.anchors) change(anchor);
}

// The sum of size(law) over the springs of the network.
template <class Size>
double sum_of_springs(Network network, const Size& size) {
  double sum = 0;
  for_springs(network, [&](const auto& spring) { sum += size(spring.law); });
  return sum;
}

// The networks as systems, and as the blocks of one system.
template <class... Networks>
std::vector<std::unique_ptr<System>> parts_of(const Networks&... networks) {
  std::vector<std::unique_ptr<System>> parts;
  (parts.push_back(make_mass_spring(networks)), ...);
  return parts;
}
template <class... Networks>
BlockDiagonalSystem in_parts(const Networks&... networks) {
  return BlockDiagonalSystem(parts_of(networks...));
}

// A mass on a spring of zero rest length, tied to the origin: m x'' = -k x in 1D, with the motion
// x(t) = x0 cos(w t) + v0/w sin(w t), w = sqrt(k/m).
struct Oscillator {
  double mass = 2, stiffness = 50, x0 = 0.8, v0 = -1.5;

  double omega() const { return std::sqrt(stiffness / mass); }
  double period() const { return 2 * M_PI / omega(); }
  double position(double t) const {
    return x0 * std::cos(omega() * t) + v0 / omega() * std::sin(omega() * t);
  }
  double velocity(double t) const {
    return v0 * std::cos(omega() * t) - x0 * omega() * std::sin(omega() * t);
  }
  double energy() const { return 0.5 * (mass * v0 * v0 + stiffness * x0 * x0); }
  Problem problem() const {
    Network network{.dimension = 1, .node_mass = Vec::Constant(1, mass)};
    network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = stiffness}}};
    return {network, {0, Vec::Constant(1, x0), Vec::Constant(1, v0)}};
  }
};

// A point of 1, 2 or 3 coordinates, the rest zero.
Eigen::Vector3d in_space(const Vec& x);

// A connected random network with gravity: some links twice, in either direction, some quartic,
// and two anchors. Every spring starts at `stretch` times its rest length, so that stretch < 1
// compresses all of it. Nodes lie about 1 m apart, never closer than 0.4 m: the derivatives of
// f stay moderate.
Problem random_network(std::mt19937& random, int dimension, int nodes, double stretch);

// n masses along x between two pins at 0 and n + 1, on n + 1 springs of one law.
Network row_of_masses(int dimension, int n, double mass, const SpringLaw& law);

// The same in 1D without rest lengths. Mode j = 1 ... n has the frequency
// 2 sqrt(k/m) sin(j pi / (2 (n + 1))) and the shape sin(i j pi / (n + 1)), i = 1 ... n.
inline Network linear_chain(int n, double mass, double stiffness) {
  return row_of_masses(1, n, mass, {stiffness});
}

// The network with a split in which every other spring of each kind is stiff, the first one too.
Network with_split(Network network);

// The network with springs as they would be without quartic parts, or without rest lengths too.
Network without_quartic(Network network);
Network without_rest_lengths(Network network);

// A smooth nonlinear motion: four masses in a row between two pins, braced across, sagging and
// swinging under gravity. Springs are stretched and compressed in turn; one is quartic. Its
// frequencies are below 25 rad/s and no spring comes near zero length.
Problem hammock(int dimension);

}  // namespace tests
}  // namespace qddot
