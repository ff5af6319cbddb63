#pragma once

#include <limits>
#include <string>
#include <vector>

#include "qddot/algebra/straight_line.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::scaling {

// Scenes of one kind and any number of nodes, and the growth of a step's costs with that number.
struct SizedScenes {
  std::string name;
  // About that many nodes, at least 2; the cloth is square and the lattice a cube.
  Scene (*draw)(double nodes);
  double springs_a_node;  // at most
  // The operations of a factorisation of its graph's matrix and the size of the factors, up to a
  // constant, for the best order of elimination (George, SIAM J. Numer. Anal. 10:2, 1973, in the
  // plane; Lipton, Rose and Tarjan, SIAM J. Numer. Anal. 16:2, 1979, in space).
  double (*factorization)(double nodes);
  double (*fill)(double nodes);
  // The work of conjugate gradients while the condition worsens with more nodes. Iterations grow
  // with the nodes along a side, and each with all nodes.
  double (*iterations)(double nodes);
};

// The fewest and most nodes that scenes are measured with.
constexpr double least_nodes = 10, most_nodes = 1e7;

// The chain, the cloth and the lattice.
const std::vector<SizedScenes>& sized_scenes();

// The scenes of that name. Throws InvalidInput if there are none.
const SizedScenes& find_sized_scenes(const std::string& name);

// So many numbers of nodes a decade from `least` to `most`, both of them among these.
std::vector<double> sizes_between(double least, double most, int in_a_decade);

// The cost of one phase of a method at one size of a scene: a row of scaling.csv.
struct PhaseCost {
  std::string scene;
  double nodes, springs;
  std::string method;  // empty for phases before any method is made
  std::string phase;
  double seconds;  // of a step; of a call for phases that run once
  double bytes = std::numeric_limits<double>::quiet_NaN();  // allocated by it; NaN: none
};

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
