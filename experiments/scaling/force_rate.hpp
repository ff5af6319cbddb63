#pragma once

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::scaling {

// The rate at which f(q) is evaluated, and the traffic and work of one evaluation.
struct ForceRate {
  double seconds = 0;  // of one evaluation
  // The bytes that one evaluation must move, each array once, and its operations (a root and a
  // division are one each). The bytes are also the working set.
  double bytes = 0, flops = 0;
};

// The fastest of evaluations of `seconds` at the scene's start. `springs`: how many of them move.
ForceRate force_rate(const ReducedScene& scene, double springs, double seconds);

}  // namespace qddot::scaling
