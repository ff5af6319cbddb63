#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiments/scaling/sized_scenes.hpp"
#include "qddot/algebra/straight_line.hpp"

namespace qddot::scaling {

// The cost of one phase of a method at one size of a scene: a row of scaling.csv.
struct PhaseCost {
  std::string scene;
  double nodes, springs;
  std::string method;  // empty for phases before any method is made
  std::string phase;
  double seconds;  // of a step; of a call for phases that run once
  double bytes = std::numeric_limits<double>::quiet_NaN();  // allocated by it; NaN: none
};

// The growth of a phase's seconds and bytes with the number of nodes, by theory and up to a
// constant. It is n, except for phases that depend on the factors (see SizedScenes).
double growth_of_seconds(const SizedScenes& scenes, const std::string& phase, double nodes);
double growth_of_bytes(const SizedScenes& scenes, const std::string& phase, double nodes);

// The expected cost of a phase at that many nodes: the last cost of that scene and method among
// `all`, times the growth by theory. Zero if there is none yet.
double expected_seconds(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                        const std::string& method, const std::string& phase, double nodes);
double expected_bytes(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                      const std::string& method, const std::string& phase, double nodes);

// An exponent of scaling: a row of exponents.csv.
struct Exponent {
  std::string scene, method, phase;
  PowerLaw fit;
  double theory;  // the exponent by theory, fitted at the same numbers of nodes
  double nodes_from, nodes_to;
};

// The exponents of all phases, in the order of their first rows, each over the last one and a half
// decades of its nodes. `fill` is the exponent of the bytes of the factors. Phases without time, or
// with fewer than three points there, have none.
std::vector<Exponent> exponents_of(const std::vector<PhaseCost>& all);

}  // namespace qddot::scaling
