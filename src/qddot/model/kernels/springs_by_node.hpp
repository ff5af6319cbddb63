#pragma once

#include <array>
#include <omp.h>
#include <vector>

#include "qddot/model/beside_force.hpp"
#include "qddot/model/compact_links.hpp"
#include "qddot/model/driven_network.hpp"
#include "qddot/model/kernels/neighbour_slices.hpp"
#include "qddot/model/kernels/rings.hpp"
#include "qddot/model/kernels/slice_parts.hpp"
#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot::kernels {

// The springs of a network in D = 1, 2 or 3 dimensions, for the processor's vectors. Each node sums
// its own springs, several nodes side by side, so that every spring is evaluated twice, once from
// each end. If Rings store its tau/l, that is computed once. A node is pulled towards a node, the
// mirror image of one, or a fixed point.
template <int D>
class SpringsByNode {
 public:
  // `links` are those of the network. `weight` (n) [N] acts besides the springs; it must outlive
  // this.
  // `driven` is what depends on time in the network, and must outlive this likewise.
  SpringsByNode(const Network& network, const CompactLinks& links, const Layout<D>& layout,
                const Vec& weight, const DrivenNetwork<D>& driven);

  const NeighbourSlices& slices() const { return slices_; }
  // The D coordinates of a row; -1 - x for a coordinate that is always x and no unknown.
  const int* unknowns(int row) const { return unknowns_.data() + D * row; }
  const SpringKernels& kernels() const { return *kernels_; }
  // Everything as kernels read it; valid as long as this.
  SpringTable table() const;

  // f = weight + the forces of the springs [N], for each node
  //   sum over its springs of (tau/l) (x_j - x_i).
  // It differs from a sum spring by spring by rounding only. It is the same to the last bit for any
  // number of threads, kind of roots and width of vectors (except v2, without fused products). q,
  // f: n. May be called from any thread.
  void sum_forces(const At& at, MutableVec f) const { sum_forces(at, f, nullptr, Undamped{}); }
  // The same with work beside it; see System::force_beside. q, f: n.
  double sum_forces(const At& at, MutableVec f, BesideForce& beside) const {
    return sum_forces(at, f, &beside, Undamped{});
  }

  // V of all springs [J], with springs to fixed points counted half; alike at every width of
  // vectors.
  double half_sum_energies(const At& at) const;
  // f = weight + the springs' discrete gradients between a and b (see DiscreteGradient).
  void sum_mean_forces(const At& a, const At& b, MutableVec f) const;

  // y = K(q) x without K, and the sums of |K_ij| over each row i. The latter count a spring to a
  // fixed point as if that were a node. q, x, y, sums: n.
  void multiply_stiffness(const At& at, const VecView& x, MutableVec y) const;
  void sum_stiffness_rows(const At& at, MutableVec sums) const;

  // friction = the forces of the dashpots [N] at q and v; for networks that have some. q, v,
  // friction: n.
  void sum_friction(const At& at, MutableVec friction) const;
  // The same, and f = weight + the forces of springs and dashpots, in one pass, with work beside it
  // unless that is nullptr.
  double sum_damped_forces(const At& at, MutableVec f, MutableVec friction,
                           BesideForce* beside) const;

  // Calls action(positions at q, from, end) for slices [from, end) until all are done, in several
  // OpenMP threads if there are enough springs. The calls must not depend on each other.
  template <class Action>
  void for_slices(const At& at, const Action& action) const;

 private:
  struct Image {
    int place, source;  // rows and extra points are at places
    std::array<double, D> signs;
  };
  // Fewer slots than these are done before a second thread has begun.
  static constexpr Index slots_worth_threads = 8000;

  // The weight as kernels read it: 24 numbers in place of n if it is the same for all nodes. With
  // driven loads, it is this thread's until the next call.
  Offset offset(const At& at) const;
  // Zeros. They are written to `numbers` (n) as well, if they are read there.
  Offset no_offset(MutableVec numbers) const;
  DashpotTable dashpot_table() const;
  // Memory for all places: this thread's until the next call. There are two.
  Positions memory(int which = 0) const;
  // The same with all of them at q.
  Positions placed(const At& at, int which = 0) const;
  // The same for a vector that is zero at all points that are no nodes, in the second memory.
  Positions placed_beside(const VecView& x) const;
  // Places the points that are no nodes: those that are fixed, and the images of parts [from, end),
  // whose slices must have their places.
  void place_points(const Positions& positions, const At& at) const;
  void place_resting_points(const Positions& velocities) const;
  // The velocities of points that rest or move.
  void place_velocities_of_points(const Positions& velocities, const At& at) const;
  // Adds the vectors of all curves, if there are any, to what is placed at moving points.
  void move_points(const Positions& positions,
                   const std::vector<Eigen::Matrix<double, D, 1>>& by) const;
  void place_images(const Positions& positions, int from, int end) const;
  void place_extra(const Positions& positions, int place, const std::array<double, D>& x) const;

  // Velocities, and what the dashpots' forces are written to.
  struct Damped {
    static constexpr bool exists = true;
    MutableVec& friction;
  };
  struct Undamped {
    static constexpr bool exists = false;
  };
  template <class Damping>
  double sum_forces(const At& at, MutableVec f, BesideForce* beside, const Damping& damped) const;
  bool uses_threads() const;
  // Fills parts_ and what belongs to them.
  void divide_into_parts();

  const SpringKernels* kernels_;
  const Vec& weight_;
  bool has_same_weights_ = false;
  std::array<double, D * slice_rows> slice_weight_{};
  const DrivenNetwork<D>& driven_;
  std::vector<std::array<double, D>> points_;
  std::vector<int> point_curves_;  // of the points; -1 where fixed
  std::vector<Image> images_;      // in the order of their sources
  NeighbourSlices slices_;
  Rings rings_;
  RingTable ring_table_{};
  bool dashpots_are_directed_ = true;  // see DashpotTable
  std::vector<int> gathered_points_;   // where the points of the slices' gathers begin
  std::vector<int> unknowns_;          // D of each row
  std::vector<SliceUnknowns> slice_unknowns_;
  SliceParts parts_;
  std::vector<int> first_image_;    // of each part, and the end
  std::vector<int> first_unknown_;  // likewise; a part's unknowns follow one another
};

template <int D>
template <class Action>
void SpringsByNode<D>::for_slices(const At& at, const Action& action) const {
  const Positions positions = memory();
  const SpringTable springs = table();
  const int count = slices_.count();
  place_points(positions, at);
  if (!uses_threads()) {
    kernels_->place(springs, at.q.data(), positions, 0, count);
    place_images(positions, 0, parts_.count());
    return action(positions, 0, count);
  }
#pragma omp parallel
  {
    const Index thread = omp_get_thread_num(), threads = omp_get_num_threads();
    const int from = static_cast<int>(count * thread / threads),
              end = static_cast<int>(count * (thread + 1) / threads);
    kernels_->place(springs, at.q.data(), positions, from, end);
#pragma omp barrier
#pragma omp single
    place_images(positions, 0, parts_.count());
    action(positions, from, end);
  }
}

}  // namespace qddot::kernels
