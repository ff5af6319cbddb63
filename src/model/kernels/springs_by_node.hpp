#pragma once

#include <array>
#include <omp.h>
#include <vector>

#include "qddot/model/kernels/lanes.hpp"
#include "qddot/model/kernels/neighbour_slices.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot::kernels {

// The springs of a network in D = 1, 2 or 3 dimensions, by the processor's vectors: each node looks
// at its own springs, as many nodes side by side as a vector has lanes, so that a spring is
// evaluated twice, once from each end, and a node's sums are its own. What a node is pulled towards
// is a node, the mirror image of one, or a fixed point.
template <int D>
class SpringsByNode {
 public:
  // The coordinates of a row; -1 where one is always zero and no unknown.
  using Unknowns = std::array<int, D>;

  // Where everything is, by place and coordinate and, where that is gathered, by point. It is this
  // thread's until the next one is made.
  class Positions {
   public:
    explicit Positions(int places);

    double* coordinate(int a, int place) const { return coordinates_ + a * stride_ + place; }
    // Of D > 1 dimensions; in one, a point is its coordinate.
    double* points() const { return points_; }

   private:
    Index stride_;
    double *coordinates_, *points_;
  };

  SpringsByNode(const Network& network, const Layout<D>& layout);

  const NeighbourSlices& slices() const { return slices_; }
  const Unknowns& unknowns(int row) const { return unknowns_[row]; }
  // How the coordinates of a slice's rows stand among the unknowns: all of them follow one another,
  // those of each row do, or some are no unknowns.
  enum class Order { by_slice, by_row, none };
  Order order(int slice) const { return order_[slice]; }

  // Calls action(slice, positions at q) for every slice, by several threads (OpenMP's) where there
  // are enough springs: what it does must depend on nothing that it does elsewhere.
  template <class Action>
  void for_slices(const Vec& q, const Action& action) const;

  // Calls add(slot, d, l2, law) for every slot of a slice, with d = x_j - x_i and l2 = |d|^2 of its
  // rows and what NeighbourSlices::laws has for it; the slots of one shift come first.
  template <int law_vectors, class Add>
  void for_slots(int slice, const Positions& positions, const Add& add) const;

 private:
  struct Image {
    int source;  // a place
    std::array<double, D> signs;
  };
  // Fewer slots than these are done before a second thread has begun.
  static constexpr Index slots_worth_threads = 8000;

  void place(const Vec& q, int slice, const Positions& positions) const;
  // What is no node; after all slices.
  void place_extras(const Positions& positions) const;
  static void copy_point(int place, const Positions& positions);

  std::vector<std::array<double, D>> points_;
  std::vector<Image> images_;  // extras are the points, then these
  NeighbourSlices slices_;
  std::vector<Unknowns> unknowns_;
  std::vector<Order> order_;
};

template <int D>
template <class Action>
void SpringsByNode<D>::for_slices(const Vec& q, const Action& action) const {
  const Positions positions(slices_.places);
  const int count = slices_.count();
  const Index slots = std::ssize(slices_.shifts) + std::ssize(slices_.gathers) / lanes;
  if (slots < slots_worth_threads || omp_in_parallel() || omp_get_max_threads() == 1) {
    for (int s = 0; s < count; ++s) place(q, s, positions);
    place_extras(positions);
    for (int s = 0; s < count; ++s) action(s, positions);
    return;
  }
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int s = 0; s < count; ++s) place(q, s, positions);
#pragma omp single
    place_extras(positions);
#pragma omp for schedule(static)
    for (int s = 0; s < count; ++s) action(s, positions);
  }
}

template <int D>
template <int law_vectors, class Add>
[[gnu::always_inline]] inline void SpringsByNode<D>::for_slots(int slice,
                                                               const Positions& positions,
                                                               const Add& add) const {
  const int row = slice * lanes;
  const auto begin = slices_.slices[slice], end = slices_.slices[slice + 1];
  const double* law = slices_.laws.data() + begin.law;
  Lanes x[D], d[D];
  for (int a = 0; a < D; ++a) x[a] = load(positions.coordinate(a, row));
  int slot = 0;
  const auto add_slot = [&] {
    Lanes l2 = d[0] * d[0];
    for (int a = 1; a < D; ++a) l2 += d[a] * d[a];
    add(slot++, d, l2, law);
    law += law_vectors * lanes;
  };
  for (int s = begin.shift; s < end.shift; ++s) {
    const int shifted = row + slices_.shifts[s];
    for (int a = 0; a < D; ++a) d[a] = load(positions.coordinate(a, shifted)) - x[a];
    add_slot();
  }
  for (int s = begin.gather; s < end.gather; s += lanes) {
    gather<D>(positions.points(), slices_.gathers.data() + s, d);
    for (int a = 0; a < D; ++a) d[a] -= x[a];
    add_slot();
  }
}

}  // namespace qddot::kernels
