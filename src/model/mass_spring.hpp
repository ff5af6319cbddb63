#pragma once

#include <memory>
#include <vector>

#include "src/model/spring.hpp"
#include "src/model/system.hpp"

namespace qddot {

// A network over the free nodes alone, numbered 0 ... N-1; what is pinned enters as points.
struct Network {
  // A spring between two different free nodes.
  struct Link {
    int i, j;
    SpringLaw law;
  };
  // A spring between a free node and a fixed point [m].
  struct Anchor {
    int i;
    Eigen::Vector3d point;
    SpringLaw law;
  };

  int dimension = 3;                                  // D = 1, 2 or 3
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // g [m/s^2]
  Vec node_mass{};                                    // [kg], length N, entries >= 0
  std::vector<Link> links{};
  std::vector<Anchor> anchors{};
  double constant_energy = 0;  // [J], of springs between fixed points
};

// The network as a System with n = D N unknowns:
//   V(q) = sum over springs of V_spring - sum over nodes of m g.x,
// f and K summed spring by spring (see spring.hpp). K's pattern is made once: a D x D block for
// each node and for each pair of nodes that a link joins. K is constant where every law is linear.
std::unique_ptr<System> make_mass_spring(const Network& network);

}  // namespace qddot
