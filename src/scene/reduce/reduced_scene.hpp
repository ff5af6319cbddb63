#pragma once

#include <memory>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/reduce/reductions.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

namespace reduce {
class Part;
class WayBack;
}  // namespace reduce

// The smallest System that moves exactly as a scene does, what was left out of it and why, and the
// way back to all of the scene's nodes. Each reduction is exact up to rounding:
//   pins                a pinned node's position is a constant; springs between two only add to V
//   duplicates          see reduce/springs.hpp
//   massless            see reduce/series.hpp
//   free_flight         a node on no spring obeys x'' = g: x = x0 + v0 t + 1/2 g t^2 (one without
//                       mass as well without g)
//   parts               no force couples what no spring joins: each is a system of its own
//   falling             what nothing is pinned to falls as a whole, see reduce/fall.hpp
//   dimension, mirror   see reduce/frame.hpp, reduce/mirror.hpp and, for the system,
//   reduce/part.hpp constant_stiffness  springs of rest length zero; on a line, see
//   reduce/straight.hpp
// Dimension, mirror and constant stiffness are found for each part by itself. Where the scene names
// stiff springs, each part's system offers SplitForces by them; everything else is as without.
//
// That the start is the drawn one is not taken on trust: every part is compared with its nodes and
// springs (Part::difference_from), and a reduction that fails is left out of that part and said to
// be, in findings(). Then all nodes, T and V are compared with the scene.
class ReducedScene {
 public:
  // The scene must be valid (see validate); it is taken as drawn, wherever it says it starts.
  // Throws std::logic_error, in a sentence, where the start is not that of the scene whatever is
  // left out: a defect of this class.
  explicit ReducedScene(const Scene& scene, const Reductions& reductions = {});
  // A system of the caller's own, of which nothing is left out: node after node has `dimension`
  // unknowns. Throws std::invalid_argument, in a sentence, where the sizes cannot be.
  ReducedScene(std::shared_ptr<const System> system, State initial, int dimension);
  ~ReducedScene();
  ReducedScene(ReducedScene&&) noexcept;
  ReducedScene& operator=(ReducedScene&&) noexcept;

  // May consist of parts (see Blocks).
  const System& system() const;
  // Positions and velocities at t = 0.
  const State& initial() const;
  // The scene's, which its nodes have.
  int dimension() const;

  // Positions [m] and velocities [m/s] of all nodes of the scene in `state`; pinned ones rest. What
  // moves in closed form is where it is at state.t.
  std::vector<Node> expand(const State& state) const;
  // The same in memory that is there: `nodes` is empty, or what this scene was expanded to before.
  void expand(const State& state, std::vector<Node>& nodes) const;
  // The same without what moves in closed form: parts as seen from the frames that fall with them,
  // other nodes at rest where they started. What is integrated can be measured by that alone.
  std::vector<Node> expand_beside_falls(const State& state) const;
  // Energies [J] of all nodes and springs of the scene; weights of pinned nodes do not count.
  double kinetic(const State& state) const;
  double potential(const State& state) const;
  // The sum of both, without the rounding of what cancels in it where something falls.
  double energy(const State& state) const;

  // Nodes without mass that have unknowns, ascending: most methods cannot take them.
  std::vector<std::size_t> massless_nodes() const;

  // What was done, in order; a reduction that found nothing says nothing.
  const std::vector<Finding>& findings() const;
  // Each of what no spring joins, by itself (see reduce/part.hpp).
  const std::vector<reduce::Part>& parts() const;
  // The scene's numbers of the nodes that each part moves, in the order of the parts: its own, and
  // the condensed ones between them.
  std::vector<std::vector<std::size_t>> nodes_by_part() const;
  // How many unknowns each part has, in the same order, in which the state has them.
  std::vector<Index> unknowns_by_part() const;

 private:
  std::unique_ptr<const reduce::WayBack> way_back_;
};

}  // namespace qddot
