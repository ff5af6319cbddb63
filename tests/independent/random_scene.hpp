#pragma once

#include <cstdint>
#include <string>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace tests {

// A small scene made by chance, valid, with a horizon of a few of its fastest vibrations, and what
// is special about it. The same seed gives the same scene everywhere.
struct RandomScene {
  Scene scene;
  std::string kind;
};

// Scenes of every kind that reductions look for, and scenes that only look like them:
// - networks,
// - mirror images, also with coincident nodes,
// - lines, planes and chains, along the axes and askew, exact or with a tiny deviation,
// - grids at rest in two layers,
// - several parts with free nodes, double and slack springs,
// - springs of rest length zero, massless joints,
// - all of these far from the origin.
// Loads act on some nodes of many of them.
RandomScene random_scene(std::uint64_t seed);

// The same scene with dashpots, air or both: in proportion to stiffness, on springs of some
// stiffnesses, so that symmetries stay, or on any. No dashpot is at a massless node.
RandomScene damped_scene(std::uint64_t seed);

// The same scene, every other one damped, with supports that move and loads that change: on few
// nodes or on all, in directions of the scene or any, by harmonics and polynomials.
RandomScene driven_scene(std::uint64_t seed);

}  // namespace tests
}  // namespace qddot
