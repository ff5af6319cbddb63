#pragma once

#include <array>
#include <vector>

#include "qddot/model/kernels/neighbours.hpp"
#include "qddot/model/kernels/spring_kernels.hpp"

namespace qddot::kernels {

// The neighbours of a slice's rows, ascending by places (Neighbour::point is the place).
using RowNeighbours = std::array<std::vector<Neighbour>, slice_rows>;

// The slots of one slice, as seen from its first row. A plan serves every slice whose neighbours
// lie alike around it, as those of most slices of a grid do.
class SlotPlan {
 public:
  struct Slot {
    bool is_shift = false;
    int shift = 0;
    std::array<int, slice_rows> place{};      // minus the first row
    std::array<int, slice_rows> neighbour{};  // its number in the row; -1 if the row has none
  };

  // Those of one shift first, then those that gather.
  const std::vector<Slot>& slots() const { return slots_; }

  // Whether this is the plan of these rows, of which the first is `first`, among `places` places.
  bool serves(int first, int places, const RowNeighbours& rows) const;
  // Makes the plan of these rows.
  void make(int first, int places, const RowNeighbours& rows);

 private:
  struct Left {
    int place, neighbour;
  };

  bool take_shifts(int first, int places);
  void take_shift(int shift);
  void take_gathers();

  std::vector<Slot> slots_;
  std::vector<int> around_;  // of each row: the number of neighbours, and their places
  bool is_general_ = false;  // no shift was left out because places end
  int least_shift_ = 0, largest_shift_ = 0;
  std::array<std::vector<Left>, slice_rows> left_;  // neighbours without a slot
  std::vector<int> shifts_;
};

}  // namespace qddot::kernels
