#pragma once

#include <memory>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/reduce/reductions.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

namespace reduce {
class Part;
struct Pieces;
}  // namespace reduce

// A system with its start, which also leads back to all nodes and energies. Made of a scene, it is
// the smallest System that moves exactly as the scene does, and tells what is left out and why.
// Each reduction is exact up to rounding:
//   pins                a pinned node's position is a constant; springs between two only add to V
//   duplicates          see reduce/springs.hpp
//   massless            see reduce/series.hpp
//   free_flight         a node on no spring obeys x'' = g: x = x0 + v0 t + 1/2 g t^2 (one without
//                       mass likewise, without g)
//   parts               no force couples two parts: each is a system of its own
//   falling             a part to which nothing is pinned falls as a whole, see reduce/fall.hpp
//   dimension, mirror   see reduce/frame.hpp, reduce/mirror.hpp; for the system, reduce/part.hpp
//   constant_stiffness  springs of rest length zero; on a line, see reduce/straight.hpp
// Dimension, mirror and constant stiffness are found for each part by itself. If the scene names
// stiff springs, each part's system offers Split by them; nothing else changes.
//
// The start is checked: every part is compared with its nodes and springs as drawn
// (Part::difference_from). A reduction that fails is left out of that part, and findings() says so.
// Then all nodes, T and V are compared with the scene.
class Model {
 public:
  // The scene must be valid (see validate); its drawn positions are the start, even if it asks for
  // equilibrium. Throws std::logic_error, in a sentence, if the start differs from the scene's for
  // every set of reductions: a defect of this class.
  explicit Model(const Scene& scene, const Reductions& reductions = {});
  // Takes a system of the caller's own, of which nothing is left out: node i has the unknowns
  // dimension i to dimension (i + 1) - 1, none is pinned, and all energy is the system's. Throws
  // std::invalid_argument, in a sentence, if the dimension or the sizes are not allowed.
  Model(std::shared_ptr<const System> system, State initial, int dimension);
  ~Model();
  Model(Model&&) noexcept;
  Model& operator=(Model&&) noexcept;

  // The same model with another system of the same unknowns in place of its own.
  Model with_system(std::shared_ptr<const System> system) &&;

  // The system that is integrated; it may consist of blocks (see System::blocks).
  const System& system() const;
  // Its positions and velocities at t = 0.
  const State& initial() const;
  // The dimension of the nodes: 1, 2 or 3.
  int dimension() const;

  // Positions [m] and velocities [m/s] of all nodes of the scene in `state`; pinned ones rest, or
  // move by their curves. Nodes that move in closed form are where they are at state.t.
  std::vector<Node> expand(const State& state) const;
  // The same into existing memory: `nodes` is empty, or a former expansion of this model.
  void expand(const State& state, std::vector<Node>& nodes) const;
  // The same without motions in closed form. Parts are seen from the frames that fall with them;
  // other nodes rest where they started. This measures only what is integrated.
  std::vector<Node> expand_beside_falls(const State& state) const;
  // The state of the unknowns at time t [s] that has these nodes: the inverse of expand(). A motion
  // that leaves the symmetry of a reduction has no such state; this is then that of its originals.
  State collect(const std::vector<Node>& nodes, double t) const;
  // The largest |x_i| over the nodes of each part, in the order of nodes_by_part(). x: n,
  // velocities or a difference of positions, which are the same beside any fall. Empty if nodes are
  // condensed, as theirs are no linear functions of x, or if there are no unknowns.
  std::vector<double> largest_by_part(const Vec& x) const;
  // Energies [J] of all nodes and springs of the scene; weights of pinned nodes do not count.
  double kinetic(const State& state) const;
  double potential(const State& state) const;
  // The energy that dashpots and air have taken up to state.t [J]: state.work.dissipated, and that
  // of motions in closed form.
  double dissipated(const State& state) const;
  // The energy that moving supports and changing loads have given up to state.t [J].
  double driven(const State& state) const;
  // T + V + dissipated - driven + released [J], which an exact motion keeps, without the rounding
  // of terms that cancel if something falls.
  double energy(const State& state) const;

  // The energy that springs held when they broke, up to state.t [J].
  double released(const State& state) const { return state.work.released; }
  // The scene's numbers of the springs that are not plain (SpringLaw::is_plain), by the numbers of
  // their phases; see Switching.
  const std::vector<std::size_t>& general_springs() const;

  // The scene's numbers of the rods in parts that are integrated, and the tension of each [N] in
  // `state`: the multipliers that keep their lengths with the forces and velocities there. NaN
  // where the rods are singular. Rods in parts that rest in their fall have no tension, and no
  // entry.
  const std::vector<std::size_t>& rods() const;
  Vec tensions(const State& state) const;
  // The tensions of these rods from the system's multipliers there. Images in a mirror share one.
  Vec tensions_by(const Vec& multipliers) const;

  // Massless nodes that have unknowns, ascending: most methods cannot run them.
  std::vector<std::size_t> massless_nodes() const;

  // The reductions' effects, in order; a reduction without effect has no entry.
  const std::vector<Finding>& findings() const;
  // The parts of the scene (see reduce/part.hpp). An own system has none; below, it counts as one.
  const std::vector<reduce::Part>& parts() const;
  // The scene's numbers of the nodes that each part moves, in the order of the parts: its own nodes
  // and the condensed ones between them.
  std::vector<std::vector<std::size_t>> nodes_by_part() const;
  // The number of unknowns of each part, in the same order, in which the state has them.
  std::vector<Index> unknowns_by_part() const;

 private:
  std::unique_ptr<reduce::Pieces> pieces_;
};

}  // namespace qddot
