#pragma once

#include <memory>
#include <vector>

#include "qddot/model/spring.hpp"
#include "qddot/model/system.hpp"
#include "qddot/model/time_curve.hpp"

namespace qddot {

// A network of springs between free nodes, numbered 0 ... N-1. Pinned nodes enter as fixed points.
//
// All springs on a line (D = 1) may have a direction s = +-1: the sign that the difference d of a
// spring's ends keeps in the motion. Their forces k (s d - l0) s are then linear in d, and K counts
// as constant. Energies and forces do not depend on s: they follow the springs' laws for any d.
struct Network {
  // A spring between two different free nodes.
  struct Link {
    int i, j;
    SpringLaw law;
    Holds holds = Holds::always;
    bool stiff = false;
    int direction = 0;
  };
  // A spring between node i and the mirror image diag(mirror) x_j of node j; the entries of mirror
  // are 1 or -1. If i = j, the spring crosses the mirror at a right angle.
  struct ImageLink {
    int i, j;
    Eigen::Vector3d mirror;
    SpringLaw law;
    Holds holds = Holds::always;
    bool stiff = false;
    int direction = 0;
  };
  // A spring between a free node and a fixed point [m], or one that moves: point + curve(t).
  struct Anchor {
    int i;
    Eigen::Vector3d point;
    SpringLaw law;
    Holds holds = Holds::always;
    bool stiff = false;
    int direction = 0;
    int curve = -1;  // of `curves`; -1: it is fixed
  };
  // A spring whose law is not plain (SpringLaw::is_general): between two different free nodes, or
  // to a point where j < 0. `number`: that of its phase, see At::phases.
  struct General {
    int i, j;
    Eigen::Vector3d point;
    SpringLaw law;
    bool stiff = false;
    int curve = -1, number = 0;
  };
  // A rod between free nodes i and diag(image) j, or from node i to a point where j < 0.
  struct Rod {
    int i, j;
    Eigen::Vector3d point;
    double length;  // [m], > 0
    int curve = -1;
    double compliance = 0;  // [m/N], see Constraints
    Eigen::Vector3d image = Eigen::Vector3d::Ones();
  };
  // A force factor curve(t) on a node [N], with V = -force.(x - origin).
  struct DrivenLoad {
    int i, curve;
    double factor;
    Eigen::Vector3d origin;
  };

  int dimension = 3;                                  // D = 1, 2 or 3
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // g [m/s^2]
  Vec node_mass{};                                    // [kg], length N, entries >= 0
  std::vector<Link> links{};
  std::vector<Anchor> anchors{};
  double constant_energy = 0;  // [J], of all that does not move
  std::vector<ImageLink> image_links{};
  std::vector<General> general{};
  std::vector<Rod> rods{};
  // Bit d of a node is set if its coordinate d stays zero and is no unknown; empty if there are
  // none.
  std::vector<unsigned> zero_coordinates{};
  Vec load{};              // constant forces beside the weight [N], D N; empty = none
  double air_damping = 0;  // alpha [1/s]: each node feels the force -alpha m v
  // Displacements of moving points, loads, or accelerations, from t = 0 on.
  std::vector<TimeCurve> curves{};
  std::vector<DrivenLoad> driven_loads{};
  bool uses_constant_stiffness = true;  // false: K counts as varying even where it is constant
  bool offers_split = false;            // whether the system offers Split, by `stiff`
};

// The order of summing forces: spring by spring, node by node in vectors
// (kernels/springs_by_node.hpp), or the faster one for that number of nodes.
enum class Forces { spring_by_spring, by_vectors, whichever_is_faster };

// Makes a System of the network, with one unknown for each of the D N coordinates that may move, in
// order:
//   V(q) = constant + sum over springs of V_spring - sum over nodes of (m g + load).x
// and, if there are curves of time, driven loads beside. Then the system offers Driving.
// f and K are sums over springs (see spring.hpp). K has a block for each node and for each pair of
// nodes that a link joins. It is constant if every law is linear or every spring has a direction.
// If any spring has a dashpot, or there is air, the force is that of positions minus C(q) v, and
// the system offers Damping. With rods it offers Constraints. Throws std::invalid_argument for
// directions in two or three dimensions or beside a quartic term. It does so too if some springs
// with a rest length have one and others have none.
//
// K's pattern, and what K is summed from, are made when somebody first asks for K, by any thread.
// So the first such question takes longer than the later ones.
std::unique_ptr<System> make_mass_spring(Network network,
                                         Forces forces = Forces::whichever_is_faster);

}  // namespace qddot
