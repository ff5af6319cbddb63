#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/reduce/part.hpp"
#include "qddot/scene/reduce/part_members.hpp"
#include "qddot/scene/reduce/reductions.hpp"
#include "qddot/scene/reduce/series.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// The contents of a ReducedScene and the steps that make it; the functions are documented there.
class Reduced {
 public:
  Reduced(const Scene& scene, const Reductions& reductions);
  // A caller's own system: it has no part, and its nodes are its unknowns.
  Reduced(std::shared_ptr<const System> system, State initial, int dimension);

  const System& system() const { return *system_; }
  const State& initial() const { return initial_; }
  int dimension() const { return dimension_; }
  const std::vector<Finding>& findings() const { return findings_; }
  const std::vector<Part>& parts() const { return parts_; }

  // Does ReducedScene::expand if `falls`, else expand_beside_falls. `nodes`: empty, or the result
  // of an earlier call.
  void expand(const State& state, bool falls, std::vector<Node>& nodes) const;
  std::vector<double> largest_by_part(const Vec& x) const;
  double kinetic(const State& state) const;
  double potential(const State& state) const;
  double energy(const State& state) const;
  std::vector<std::size_t> massless_nodes() const;
  std::vector<std::vector<std::size_t>> nodes_by_part() const;
  std::vector<Index> unknowns_by_part() const;

 private:
  // A node that moves in closed form, x = x0 + v0 t + 1/2 a t^2, a = g + load/m. It is on no
  // spring, or in a part that rests in its falling frame.
  struct Flying {
    std::size_t node;
    Eigen::Vector3d velocity, gravity;  // v0 [m/s], a [m/s^2]

    Eigen::Vector3d displacement(double t) const { return t * velocity + (0.5 * t * t) * gravity; }
    Eigen::Vector3d velocity_at(double t) const { return velocity + t * gravity; }
  };
  // Calls action(part, its q, its v) for each part that falls as a whole.
  template <class Action>
  void for_falling(const State& state, const Action& action) const;

  void expand_own(const State& state, std::vector<Node>& nodes) const;

  // The steps of the reduction, in order.
  void leave_out_pins();
  void merge(std::vector<Spring>& springs);
  void condense(std::vector<Spring>& springs);
  std::vector<PartMembers> divide(const std::vector<Spring>& springs, const Reductions& reductions);
  // The part as its motion is integrated; nothing if it rests in its falling frame.
  std::optional<DrawnPart> moving_part(const PartMembers& members,
                                       const std::vector<Spring>& springs,
                                       const Reductions& reductions);
  void leave_out_static_springs(const std::vector<Spring>& springs);
  void build(const std::vector<PartMembers>& parts, const std::vector<Spring>& springs,
             const Reductions& reductions);
  // The part with all reductions that leave its start as drawn.
  Part faithful_part(const DrawnPart& drawn, Reductions reductions);
  // Checks that each free node has one place, and that energies are the scene's. Positions and
  // velocities of nodes on springs are compared part by part; joints are placed by their series.
  void check(const Scene& scene) const;
  void report(Reduction reduction, std::string what) {
    findings_.push_back({reduction, std::move(what)});
  }

  bool is_own_ = false;      // of a caller's own system, not of a scene
  std::vector<Node> nodes_;  // as drawn, with condensed ones at their places
  int dimension_;
  Eigen::Vector3d gravity_{0, 0, 0};
  std::optional<double> stiff_above_;
  std::vector<Series> series_;
  std::vector<Flying> flying_;
  std::size_t resting_ = 0;  // parts that rest in their fall
  std::vector<Part> parts_;
  std::shared_ptr<const System> system_;
  double static_energy_ = 0;  // of springs between pinned nodes, and of the parts' origins
  State initial_;
  std::vector<Finding> findings_;
};

}  // namespace qddot::reduce
