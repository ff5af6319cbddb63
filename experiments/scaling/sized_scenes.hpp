#pragma once

#include <string>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::scaling {

// Scenes of one kind and any number of nodes, and how the costs of a step grow with these.
struct SizedScenes {
  std::string name;
  // About that many nodes, at least 2; the cloth is square and the lattice a cube.
  Scene (*draw)(double nodes);
  double springs_a_node;  // at most
  // What factorising a matrix of its graph takes, and what its factors hold, up to a constant, with
  // the best order of elimination (George, SIAM J. Numer. Anal. 10:2, 1973, in the plane; Lipton,
  // Rose and Tarjan, SIAM J. Numer. Anal. 16:2, 1979, in space).
  double (*factorization)(double nodes);
  double (*fill)(double nodes);
  // What conjugate gradients take while more nodes make the matrix worse conditioned: iterations in
  // proportion to the nodes along a side, each in proportion to all nodes.
  double (*iterations)(double nodes);
};

// The chain, the cloth and the lattice.
const std::vector<SizedScenes>& sized_scenes();

// The one of that name. Throws InvalidInput where there is none.
const SizedScenes& find_sized_scenes(const std::string& name);

}  // namespace qddot::scaling
