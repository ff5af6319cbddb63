#pragma once

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::scaling {

// How fast f(q) is evaluated, and what of the machine that takes.
struct ForceRate {
  double seconds = 0;  // of one evaluation
  // What one evaluation has to move [bytes], each array once, and to do [operations; a root and a
  // division are one each]. All arrays are in use, so that is its working set as well.
  double bytes = 0, flops = 0;
};

// The fastest of evaluations of `seconds` at the scene's start. `springs`: how many of them move.
ForceRate force_rate(const ReducedScene& scene, double springs, double seconds);

}  // namespace qddot::scaling
