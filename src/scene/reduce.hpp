#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/model/system.hpp"
#include "src/scene/reduce/components.hpp"
#include "src/scene/reduce/part.hpp"
#include "src/scene/reduce/reductions.hpp"
#include "src/scene/reduce/series.hpp"
#include "src/scene/scene.hpp"

namespace qddot {

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
// stiff springs, each part's system offers a split() by them; everything else is as without.
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

  // May consist of parts (see System::parts).
  const System& system() const { return *system_; }
  // Positions and velocities at t = 0.
  const State& initial() const { return initial_; }
  // The scene's, which its nodes have.
  int dimension() const { return dimension_; }

  // Positions [m] and velocities [m/s] of all nodes of the scene in `state`; pinned ones rest. What
  // moves in closed form is where it is at state.t.
  std::vector<Node> expand(const State& state) const;
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
  const std::vector<Finding>& findings() const { return findings_; }
  const std::vector<Part>& parts() const { return parts_; }
  // The scene's numbers of the nodes that each part moves, in the order of the parts: its own, and
  // the condensed ones between them.
  std::vector<std::vector<std::size_t>> nodes_by_part() const;

 private:
  // A node that moves in closed form, x = x0 + v0 t + 1/2 g t^2: by itself, or in a part that rests
  // in the frame that falls with it.
  struct Flying {
    std::size_t node;
    Eigen::Vector3d velocity, gravity;  // v0 [m/s], g [m/s^2]

    Eigen::Vector3d displacement(double t) const { return t * velocity + (0.5 * t * t) * gravity; }
    Eigen::Vector3d velocity_at(double t) const { return velocity + t * gravity; }
  };
  std::vector<Node> expand(const State& state, bool falls) const;
  // Calls action(part, its q, its v) for each part that falls as a whole.
  template <class Action>
  void for_falling(const State& state, const Action& action) const;

  // Each step of the reduction, in order.
  void leave_out_pins();
  void merge(std::vector<Spring>& springs);
  void condense(std::vector<Spring>& springs);
  std::vector<Component> divide(const std::vector<Spring>& springs, const Reductions& reductions);
  // The body of a component as its motion is integrated; nothing where it rests in its fall.
  std::optional<Body> body_of(const Component& component, const std::vector<Spring>& springs,
                              const Reductions& reductions);
  void leave_out_static_springs(const std::vector<Spring>& springs);
  void build(const std::vector<Component>& components, const std::vector<Spring>& springs,
             const Reductions& reductions);
  // Reduced as far as it starts as the body does.
  Part faithful_part(const Body& body, Reductions reductions);
  // That each free node has one place, and that energies are the scene's. Positions and velocities
  // of nodes on springs are compared part by part, those of joints are placed by their series.
  void check(const Scene& scene) const;
  void report(Reduction reduction, std::string what) {
    findings_.push_back({reduction, std::move(what)});
  }

  std::vector<Node> nodes_;  // as drawn, condensed ones in their places
  int dimension_;
  Eigen::Vector3d gravity_;
  std::optional<double> stiff_above_;
  std::vector<Series> series_;
  std::vector<Flying> flying_;
  std::size_t resting_ = 0;  // parts that rest in their fall
  std::vector<Part> parts_;
  std::unique_ptr<System> system_;
  double static_energy_ = 0;  // of springs between pinned nodes, and of the parts' origins
  State initial_;
  std::vector<Finding> findings_;
};

}  // namespace qddot
