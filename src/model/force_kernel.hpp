#pragma once

#include <array>
#include <vector>

#include "src/model/layout.hpp"
#include "src/model/mass_spring.hpp"
#include "src/model/neighbour_slices.hpp"

namespace qddot {

// The forces of a network's springs, D = 1, 2 or 3, by the processor's vectors: each node sums
// those of its own springs, as many nodes side by side as a vector has lanes,
//   f_i = sum over its springs of (tau/l) (x_j - x_i),
// x_j a node, the mirror image of one, or a fixed point. So each spring is evaluated twice, once
// from each end, and nothing is written but f. It differs from a sum spring by spring by rounding,
// and by nothing with the number of threads (OpenMP's).
template <int D>
class ForceKernel {
 public:
  ForceKernel(const Network& network, const Layout<D>& layout);

  // f = offset + the forces [N]; q, offset, f: n. May be called from any thread.
  void force(const Vec& q, const Vec& offset, Vec& f) const;

 private:
  using Unknowns = std::array<int, D>;
  struct Image {
    int source;
    std::array<double, D> signs;
  };
  class Places;

  template <int law_vectors>
  void run(const Vec& q, const Vec& offset, Vec& f) const;
  void place(const Vec& q, int slice, Places& places) const;
  void place_extras(Places& places) const;
  template <int law_vectors>
  void sum(const Places& places, int slice, const Vec& offset, Vec& f) const;

  std::vector<std::array<double, D>> points_;
  std::vector<Image> images_;  // of nodes, then of places; extras are the points, then these
  NeighbourSlices slices_;
  std::vector<Unknowns> unknowns_;  // of each row's coordinates; -1 where one is always zero
  std::vector<int> first_unknown_;  // of each slice whose rows' unknowns follow one another, or -1
};

}  // namespace qddot
