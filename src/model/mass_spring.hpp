#pragma once

#include <memory>
#include <vector>

#include "qddot/model/spring.hpp"
#include "qddot/model/system.hpp"

namespace qddot {

// A network over the free nodes alone, numbered 0 ... N-1; what is pinned enters as points.
//
// In one dimension all springs may have a direction s = +-1: the sign that the difference d of
// their ends is known to keep in the network's motion. Their forces k (s d - l0) s are linear in d
// for as long as it does, and K counts as constant. Nothing else depends on it: energies and forces
// are those of the springs' laws, whatever d is.
struct Network {
  // A spring between two different free nodes.
  struct Link {
    int i, j;
    SpringLaw law;
    Holds holds = Holds::always;
    bool stiff = false;
    int direction = 0;
  };
  // A spring between node i and the mirror image of node j, diag(mirror) x_j with entries 1 and -1;
  // i = j is a spring that crosses the mirror at a right angle.
  struct ImageLink {
    int i, j;
    Eigen::Vector3d mirror;
    SpringLaw law;
    Holds holds = Holds::always;
    bool stiff = false;
    int direction = 0;
  };
  // A spring between a free node and a fixed point [m].
  struct Anchor {
    int i;
    Eigen::Vector3d point;
    SpringLaw law;
    Holds holds = Holds::always;
    bool stiff = false;
    int direction = 0;
  };

  int dimension = 3;                                  // D = 1, 2 or 3
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // g [m/s^2]
  Vec node_mass{};                                    // [kg], length N, entries >= 0
  std::vector<Link> links{};
  std::vector<Anchor> anchors{};
  double constant_energy = 0;  // [J], of whatever does not move
  std::vector<ImageLink> image_links{};
  // Coordinates that stay zero, a bit d for coordinate d of each node, and are no unknowns; empty
  // where there are none.
  std::vector<unsigned> zero_coordinates{};
  Vec load{};                           // constant forces beside the weight [N], D N; empty = none
  bool uses_constant_stiffness = true;  // false: K counts as varying even where it is constant
  bool offers_split = false;            // whether the system is to offer SplitForces, by `stiff`
};

// How forces are summed: spring by spring as the formula says, by vectors as force_kernel.hpp says,
// or by what is faster for as many nodes.
enum class Forces { spring_by_spring, by_vectors, whichever_is_faster };

// The network as a System with an unknown for each of the D N coordinates that may move, in order:
//   V(q) = constant + sum over springs of V_spring - sum over nodes of (m g + load).x,
// f and K sums over springs (see spring.hpp). K's pattern is made once: a block for each node
// and for each pair of nodes that a link joins. K is constant where every law is linear or every
// spring keeps a direction. Throws std::invalid_argument on directions in two dimensions or three,
// beside a quartic term, or of some springs that have a rest length and not of all.
std::unique_ptr<System> make_mass_spring(const Network& network,
                                         Forces forces = Forces::whichever_is_faster);

}  // namespace qddot
