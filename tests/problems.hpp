#pragma once

#include <cmath>
#include <random>

#include "qddot/model/mass_spring.hpp"

namespace qddot {
inline namespace tests {

// A network and where it starts.
struct Problem {
  Network network;
  State initial;
};

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

// The network with a split in which every other spring of each kind is stiff, the first one too.
Network with_split(Network network);

// A smooth nonlinear motion: four masses in a row between two pins, braced across, sagging and
// swinging under gravity. Springs are stretched and compressed in turn; one is quartic. Its
// frequencies are below 25 rad/s and no spring comes near zero length.
Problem hammock(int dimension);

}  // namespace tests
}  // namespace qddot
