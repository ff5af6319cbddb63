#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "qddot/model/mass_spring.hpp"
#include "qddot/scene/reduce/drawn_part.hpp"
#include "qddot/scene/reduce/frame.hpp"
#include "qddot/scene/reduce/mirror.hpp"
#include "qddot/scene/reduce/reductions.hpp"
#include "qddot/scene/reduce/signs.hpp"

namespace qddot::reduce {

struct DrawnEnergies;
struct FoldedNodes;

// The tension of a rod, as a share of the multiplier of a constraint.
struct RodShare {
  Index constraint;
  double share;
};

class FoldedSprings;
struct FoldedSpring;

// A part's motion in the fewest unknowns q. Every node's position is an affine function of them,
//   x_i = origin + frame.origin + axes diag(signs_i) y_original(i),   in short x = P q + c.
// The originals are the nodes on one side of each mirror. The energy of all springs, written in q,
// gives the equations of motion with M = P'M_full P, f = P'f_full, K = P'K_full P. Springs that are
// images of each other have the same energy: one stands for all, stiffer by their number, and
// nothing is multiplied by P. The origin is the part's own (see DrawnPart), so that small numbers
// keep their digits wherever the part lies.
class Part {
 public:
  // It has no system yet.
  Part(const DrawnPart& drawn, int dimension, const Reductions& reductions);
  // Makes the system, once and before all that asks for it. The springs of the drawn part are no
  // longer needed then: two lists of them beside a system's would be most of the memory.
  void make_system();

  const System& system() const { return *system_; }
  // The number of its unknowns.
  Index unknowns() const {
    return layout_.empty() ? 0 : Index{layout_.back().first} + layout_.back().count;
  }
  // Give away the state of its unknowns at the start, and the system; the rest remains.
  State take_initial() { return std::move(initial_); }
  std::unique_ptr<System> take_system() { return std::move(system_); }

  // Its mirrors, in coordinates from the part's origin.
  const Mirrors& mirrors() const { return mirrors_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  // The potential energy beside that of the system [J]: -(M g + the sum of loads).origin.
  double energy_of_origin() const { return energy_of_origin_; }
  // The scene's numbers of its nodes.
  const std::vector<std::size_t>& nodes() const { return nodes_; }
  std::size_t originals() const { return layout_.size(); }
  // The numbers, in the list that its springs were drawn from, of those that are not plain, in the
  // order of their phases (Switching).
  const std::vector<int>& general() const { return general_; }
  // The numbers of its rods, in the order of its system's constraints; and the share of each in the
  // multiplier of its constraint.
  const std::vector<int>& rods() const { return rods_; }
  const std::vector<RodShare>& shares() const { return shares_; }
  bool is_loaded() const { return is_loaded_; }
  // Whether K is constant though springs on a line have rest lengths (see straight.hpp).
  bool is_straightened() const { return is_straightened_; }

  // The frame that falls with it, if nothing is pinned to it; all else is as seen from there.
  const Fall& fall() const { return fall_; }

  // Computes positions and velocities of its nodes from its unknowns, all moved by `displacement`
  // [m] and `velocity` [m/s], and sets them in the scene's `nodes`.
  void expand(const Eigen::Ref<const Vec>& q, const Eigen::Ref<const Vec>& v,
              const Eigen::Vector3d& displacement, const Eigen::Vector3d& velocity,
              std::vector<Node>& nodes) const;
  // The inverse: the unknowns `q` and `v` of its originals among the scene's `nodes`.
  void collect(const std::vector<Node>& nodes, const Eigen::Vector3d& displacement,
               const Eigen::Vector3d& velocity, Eigen::Ref<Vec> q, Eigen::Ref<Vec> v) const;
  // The largest |x_i| of a node, for velocities or a difference of positions in its unknowns: axes
  // and signs change no length.
  double largest(const Eigen::Ref<const Vec>& x) const;
  // S = sum m y [kg m] in the scene's coordinates and P = sum m y' [kg m/s] of its nodes (see
  // Fall).
  struct Moments {
    Eigen::Vector3d first, momentum;
  };
  Moments moments(const Eigen::Ref<const Vec>& q, const Eigen::Ref<const Vec>& v) const;

  // The difference from the drawn part at the start, with both numbers; nothing if all agrees. It
  // compares nodes, masses, positions, velocities and these energies of it, up to rounding and the
  // tolerances of the reductions. Momenta and angular momenta follow from the first four. All
  // agrees by construction: a defect of a reduction shows here. Call before take_system().
  std::optional<std::string> difference_from(const DrawnPart& drawn,
                                             const DrawnEnergies& energies) const;

 private:
  // A node as the image of an original, by the signs of its coordinates.
  struct Image {
    int original;
    Signs signs;
  };
  // The places of an original's coordinates in q: `axis[a]` is unknown first + a.
  struct Unknowns {
    int first;
    std::int8_t count;
    std::array<std::int8_t, 3> axis;
  };

  void make_network(const DrawnPart& drawn, int dimension, bool with_pins);
  void note_rods(const FoldedSpring& rod, const FoldedSprings& springs, const DrawnPart& drawn);
  void set_initial(const DrawnPart& drawn, const FoldedNodes& half, const std::vector<int>& numbers,
                   Index size);

  struct Motion {
    Eigen::Vector3d x, v;
  };
  // Position and velocity of its node number i, from the part's origin.
  Motion motion(std::size_t i, const Eigen::Ref<const Vec>& q,
                const Eigen::Ref<const Vec>& v) const;
  std::optional<std::string> places_differ(const DrawnPart& drawn, double tolerance,
                                           double speed_tolerance) const;
  std::optional<std::string> masses_differ(const DrawnPart& drawn) const;

  Mirrors mirrors_;
  Eigen::Vector3d origin_;
  double energy_of_origin_ = 0;
  Fall fall_;
  std::vector<std::size_t> nodes_;
  std::vector<double> masses_;    // of the nodes [kg]
  std::vector<Image> images_;     // likewise
  std::vector<Unknowns> layout_;  // of the originals
  std::vector<int> general_;      // springs
  std::vector<int> rods_;         // likewise
  std::vector<RodShare> shares_;  // of the rods
  Network network_;               // until the system is made of it
  std::vector<bool> is_held_;
  std::unique_ptr<System> system_;
  State initial_;
  bool is_straightened_ = false, is_loaded_ = false;
};

}  // namespace qddot::reduce
