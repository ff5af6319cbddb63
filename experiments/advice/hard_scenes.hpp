#pragma once

#include <cstddef>

#include "experiments/advice/draws.hpp"
#include "experiments/advice/hard_case.hpp"

namespace qddot::judged_advice {

// A direction at random in the first d axes.
Eigen::Vector3d random_direction(Draws& draw, int d);

// Turns everything in the plane or in space. A scene in the plane may come to lie in space, in a
// plane that is none of the coordinate planes. Does nothing on a line.
void turn(Scene& scene, Draws& draw);

// Adds a spring of the stiffness k [N/m], the rest length l0 [m] and the quartic term c [N/m^3].
void join(Scene& scene, std::size_t i, std::size_t j, double k, double l0, double c = 0);

// The distance of two nodes [m].
double apart(const Scene& scene, std::size_t i, std::size_t j);

// A tree of nodes, about a metre apart, with more springs between them. Each spring is up to
// `strain` longer or shorter than at rest, in parts of its length. The first node may be pinned.
Scene net(Draws& draw, int d, int nodes, double strain, bool is_pinned);

// The largest natural frequency at the start [rad/s]; 1 if nothing vibrates there.
double fastest(const HardCase& c);

}  // namespace qddot::judged_advice
