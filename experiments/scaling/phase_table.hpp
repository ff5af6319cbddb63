#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiments/scaling/sized_scenes.hpp"
#include "qddot/measure/trend/power_law.hpp"

namespace qddot::scaling {

using namespace measure;

// What one phase of a method takes at one size of a scene: a row of scaling.csv.
struct PhaseCost {
  std::string scene;
  double nodes, springs;
  std::string method;  // empty for what is done before any method is made
  std::string phase;
  double seconds;  // of a step; of a call, where it is called once
  double bytes = std::numeric_limits<double>::quiet_NaN();  // that it holds; no number: none
};

// How the seconds and the bytes of a phase grow with the number of nodes, by theory and up to a
// constant: n, but where the factors come in (see SizedScenes).
double growth_of_seconds(const SizedScenes& scenes, const std::string& phase, double nodes);
double growth_of_bytes(const SizedScenes& scenes, const std::string& phase, double nodes);

// What a phase's costs `all` let one expect at that many nodes, growing as theory has it from the
// last of that scene and method; zero where there is none yet.
double expected_seconds(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                        const std::string& method, const std::string& phase, double nodes);
double expected_bytes(const std::vector<PhaseCost>& all, const SizedScenes& scenes,
                      const std::string& method, const std::string& phase, double nodes);

// An exponent of scaling: a row of exponents.csv.
struct Exponent {
  std::string scene, method, phase;
  PowerLaw fit;
  double theory;  // what theory's law gives, fitted at the same numbers of nodes
  double nodes_from, nodes_to;
};

// The exponents of all phases over the last one and a half decades of each one's nodes, in the
// order in which they first appear; `fill` is that of the bytes of the factors. Phases with fewer
// than three points there, or that take no time, have none.
std::vector<Exponent> exponents_of(const std::vector<PhaseCost>& all);

}  // namespace qddot::scaling
